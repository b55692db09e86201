#!/usr/bin/env bash
# Builds the fuzzers with clang++ and its sanitizers, and runs them one after the other.
#
#   scripts/fuzz.sh [--seconds N] [READER …]
#
# READER is ply, obj or scene; all of them by default, 60 seconds each. Needs `scripts/install-deps.sh --long`. What makes
# a reader fail is left in build/fuzz/READER-…, to be given to build/fuzz/READER_fuzz again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

seconds=60
readers=()
while (($# > 0)); do
  case "$1" in
    --seconds) seconds=${2:?--seconds needs a number}; shift ;;
    --seconds=*) seconds=${1#--seconds=} ;;
    ply | obj | scene) readers+=("$1") ;;
    -h | --help) sed -n '2,/^set/{s/^# \{0,1\}//;/^set/d;p}' "${BASH_SOURCE[0]}"; exit 0 ;;
    *) echo "fuzz.sh: unknown word $1; allowed: --seconds N, ply, obj, scene" >&2; exit 2 ;;
  esac
  shift
done
if ((${#readers[@]} == 0)); then readers=(ply obj scene); fi

launcher=()
if command -v ccache > /dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
cmake -S . -B build/fuzz -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo -DHALFSLOPE_FUZZ=ON \
  -DHALFSLOPE_BUILD_TESTS=OFF -DHALFSLOPE_BUILD_BENCHMARKS=OFF "${launcher[@]}"
cmake --build build/fuzz --parallel "$(nproc)" --target fuzz

seeds=build/fuzz/seeds
rm -rf "$seeds"
mkdir -p "$seeds"/{ply,obj,scene}

vertices='0 0 0 0 0 1 0 0
1 0 0 0 0 1 1 0
1 1 0 0 0 1 1 1
0 1 0 0 0 1 0 1'
header() {
  printf 'ply\nformat %s 1.0\ncomment seed\nelement vertex %d\n' "$1" "$2"
  printf 'property float %s\n' x y z nx ny nz u v
  printf 'element face 1\nproperty uchar material\nproperty list uchar int vertex_indices\nend_header\n'
}
{ header ascii 4; printf '%s\n7 4 0 1 2 3\n' "$vertices"; } > "$seeds/ply/ascii.ply"
zeros() { head -c "$1" /dev/zero; }
{ header binary_little_endian 3; zeros 96; printf '\7\3\0\0\0\0\1\0\0\0\2\0\0\0'; } > "$seeds/ply/little.ply"
{ header binary_big_endian 3; zeros 96; printf '\7\3\0\0\0\0\0\0\0\1\0\0\0\2'; } > "$seeds/ply/big.ply"
{
  printf 'ply\nformat ascii 1.0\nelement camera 1\nproperty list ushort double k\nelement vertex 3\n'
  printf 'property %s\n' 'double z' 'short y' 'uint8 red' 'list char int16 tags' 'int32 x' 'float s' 'float t'
  printf 'element face 1\nproperty list uint32 uint32 vertex_index\nend_header\n'
  printf '2 1 2\n1 0 9 1 5 0 .5 .5\n2 1 9 0 1 1e-3 +1\n3 -2 9 0 0 0 0\n3 0 1 2\n'
} > "$seeds/ply/other.ply"
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0 1\nv 0 1e0 -.5\nf 1 2 3 4\nf -1 -2 -3\n' > "$seeds/obj/plain.obj"
{
  printf '# seed\nmtllib a.mtl\no thing\nv 0 0 0 1 1 1\r\nv 1 0 0\rv 1 1 0\nvt 0 0\nvt 1 1 0\nvn 0 0 1\nvn 0 0 0\ng a\ns 1\n'
  printf 'usemtl b\nf 1/1/1 2/2/1 3/1/2\nf 1//1 2//1 3//2\nf 1/1 2/1 3/2\nl 1 2\n'
} > "$seeds/obj/full.obj"
cp scenes/*.xml "$seeds/scene/"
for type in ply obj; do
  printf '<scene version="3.0.0"><sensor type="perspective"/><shape type="%s"><string name="filename" value="a.%s"/></shape></scene>' \
    "$type" "$type" > "$seeds/scene/$type.xml"
done

for reader in "${readers[@]}"; do
  echo "fuzz: $reader, $seconds seconds"
  "build/fuzz/${reader}_fuzz" -max_total_time="$seconds" -timeout=2 -rss_limit_mb=1024 -malloc_limit_mb=256 -max_len=16384 \
    -verbosity=0 -print_funcs=0 -print_final_stats=1 -artifact_prefix="build/fuzz/$reader-" "$seeds/$reader"
done
