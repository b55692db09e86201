#!/usr/bin/env bash
# Installs the Debian 12 packages that halfslope is built with, as root or through sudo; only those that are missing.
# docs/dependencies.md says why each is here.
set -euo pipefail

packages=(
  g++ cmake ninja-build pkg-config
  libgtest-dev libgmock-dev libbenchmark-dev
  libeigen3-dev libnanoflann-dev libopenexr-dev libxsimd-dev libtbb-dev librandom123-dev
  libcli11-dev libtomlplusplus-dev libpugixml-dev libfmt-dev nlohmann-json3-dev libboost-dev
  libpng-dev libfreetype-dev fonts-dejavu-core
  clang-format qemu-user git ca-certificates
)

case "${1:-}" in
  "") ;;
  --list) printf '%s\n' "${packages[@]}"; exit 0 ;;
  *) echo "usage: scripts/install-deps.sh [--list]" >&2; exit 2 ;;
esac

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
