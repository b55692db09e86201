#!/usr/bin/env bash
# Installs the Debian 12 packages that halfslope is built with, as root or through sudo; only those that are missing.
#
#   scripts/install-deps.sh [--long] [--list]
#
# --long adds what only `scripts/test.sh --long` needs; --list prints the packages and installs nothing.
# docs/dependencies.md says why each is here.
set -euo pipefail

packages=(
  g++ cmake ninja-build pkg-config
  libgtest-dev libgmock-dev libbenchmark-dev
  libeigen3-dev libnanoflann-dev libopenexr-dev libxsimd-dev libtbb-dev librandom123-dev
  libcli11-dev libtomlplusplus-dev libpugixml-dev libfmt-dev nlohmann-json3-dev libboost-dev
  libpng-dev libfreetype-dev fonts-dejavu-core libembree-dev libtinyobjloader-dev
  clang-format qemu-user git ca-certificates
)

list=no
for argument in "$@"; do
  case "$argument" in
    --long) packages+=(clang libclang-rt-dev) ;;
    --list) list=yes ;;
    *) echo "usage: scripts/install-deps.sh [--long] [--list]" >&2; exit 2 ;;
  esac
done
if [[ $list == yes ]]; then printf '%s\n' "${packages[@]}"; exit 0; fi

if ! command -v apt-get > /dev/null; then
  echo "install-deps: no apt-get here; install the like of these yourself and give --no-install: ${packages[*]}" >&2
  exit 1
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2> /dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  echo "install-deps: all ${#packages[@]} packages are installed"
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo > /dev/null; then
    echo "install-deps: neither root nor sudo; as root, run: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q "$@"; }

echo "install-deps: installing ${missing[*]}"
# A container's base often comes without package lists.
compgen -G '/var/lib/apt/lists/*Packages*' > /dev/null || apt update
install=(install --yes --no-install-recommends "${missing[@]}")
# Old lists name versions that the archive no longer has.
apt "${install[@]}" || { apt update && apt "${install[@]}"; }
