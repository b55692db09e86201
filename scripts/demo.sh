#!/usr/bin/env bash
# Veach and Guibas's plates and lights, from a fresh clone to the figures' data.
#
#   scripts/demo.sh [--no-install] [flags of `halfslope run` …]
#
# Installs the Debian packages that are missing (--no-install skips that), builds Release, runs
# experiments/veach_mis.toml and says where the files are. Paths are relative to the repository.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

install=yes
out=
flags=()
while (($# > 0)); do
  case "$1" in
    --no-install) install=no ;;
    -h | --help) sed -n '2,/^set/{s/^# \{0,1\}//;/^set/d;p}' "${BASH_SOURCE[0]}"; exit 0 ;;
    --out) out=${2:?--out needs a folder}; shift ;;
    --out=*) out=${1#--out=} ;;
    *) flags+=("$1") ;;
  esac
  shift
done
out=${out:-out/veach-mis}

if [[ $install == yes ]]; then scripts/install-deps.sh; fi
launcher=()
if command -v ccache > /dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
cmake --preset release "${launcher[@]}"
cmake --build --preset release --parallel "$(nproc)" --target halfslope

build/release/halfslope run experiments/veach_mis.toml --out "$out" "${flags[@]}"

echo
echo "The files are in $out:"
describe() { if [[ -e $out/$1 ]]; then printf '  %-18s %s\n' "$1" "$2"; fi; }
describe convergence.csv "errors of every estimator and sampler at every N, with intervals"
describe rates.csv "the slopes of log RMSE against log N"
describe replicates.csv "each replicate's errors"
describe regions.csv "errors over parts of the image: by shape, and by the light it mirrors"
describe images "EXR images: mean, variance, squared error, bias"
describe reference.exr "the reference image"
describe manifest.json "what ran: the experiment, version, compiler, machine, and what was skipped"
