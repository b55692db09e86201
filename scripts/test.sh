#!/usr/bin/env bash
# Builds Release and runs every test.
#
#   scripts/test.sh [--no-install] [--long]
#
# Installs the Debian packages that are missing (--no-install skips that). --long adds the tests with the label `long`, and
# a minute of each fuzzer.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

install=yes
long=no
for argument in "$@"; do
  case "$argument" in
    --no-install) install=no ;;
    --long) long=yes ;;
    -h | --help) sed -n '2,/^set/{s/^# \{0,1\}//;/^set/d;p}' "${BASH_SOURCE[0]}"; exit 0 ;;
    *) echo "test.sh: unknown flag $argument; allowed: --no-install --long" >&2; exit 2 ;;
  esac
done

deps=()
if [[ $long == yes ]]; then deps=(--long); fi
if [[ $install == yes ]]; then scripts/install-deps.sh "${deps[@]}"; fi
launcher=()
if command -v ccache > /dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
cmake --preset release "${launcher[@]}"
cmake --build --preset release --parallel "$(nproc)"
ctest --preset release --parallel "$(nproc)"
if [[ $long == yes ]]; then
  ctest --test-dir build/release --output-on-failure --parallel "$(nproc)" --label-regex '^long$'
  scripts/fuzz.sh
fi
