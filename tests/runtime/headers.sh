#!/bin/sh
# Every runtime header alone, and all that firmware may use, under harsh flags: no warning, no foreign include, no foreign symbol.
# Usage: headers.sh SOURCE_DIR COMPILER... ; leaves nothing behind.
set -eu
source=$1; shift
include=$source/runtime/include
hosted='dynamic.hpp dynamic_enclosed.hpp error_bounds.hpp mapped_targets.hpp'
harsh='-std=c++17 -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Wpedantic -Werror -fno-exceptions -fno-rtti'
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bad=0
fail() { echo "$*" >&2; bad=1; }

for compiler in "$@"; do
  for header in "$include"/etlmon/*.hpp; do
    name=$(basename "$header")
    printf '#include "etlmon/%s"\n#include "etlmon/%s"\n' "$name" "$name" > "$work/alone.cpp"
    "$compiler" $harsh -O1 -I "$include" -c "$work/alone.cpp" -o "$work/alone.o" || fail "$compiler: $name does not stand alone"
    case " $hosted " in *" $name "*) continue ;; esac
    "$compiler" $harsh -O1 -ffreestanding -I "$include" -c "$work/alone.cpp" -o "$work/alone.o" ||
      fail "$compiler: $name does not stand alone where there is no library"
    foreign=$(grep '^ *# *include' "$header" | grep -v -E '"etlmon/[a-z_]+\.(hpp|inc)"|<(stdint|stddef|float|string|math)\.h>') || true
    [ -z "$foreign" ] || fail "$name includes $foreign"
  done

  for flags in '-O0' '-Os' '-O2' '-O2 -ffreestanding' '-O3 -ffast-math' '-O2 -DETLMON_NO_PACKS' '-O2 -DETLMON_NO_DISPATCH' '-O2 -DWITH_ANGULAR'; do
    "$compiler" $harsh $flags -I "$include" -c "$source/tests/runtime/firmware_use.cpp" -o "$work/use.o" ||
      { fail "$compiler $flags: does not compile"; continue; }
    allowed='sqrtf|memcpy|memset'
    case $flags in *ANGULAR*) allowed="$allowed|atanf" ;; esac
    foreign=$(nm -u "$work/use.o" | awk '{ print $2 }' | grep -v -x -E "$allowed") || true
    [ -z "$foreign" ] || fail "$compiler $flags: refers to" $foreign
    changing=$(nm -C "$work/use.o" | grep -E ' [BbDdCc] ') || true
    [ -z "$changing" ] || fail "$compiler $flags: global data that may change: $changing"
  done
done
exit $bad
