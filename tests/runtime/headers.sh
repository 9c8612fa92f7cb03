#!/bin/sh
# Every runtime header alone, and all that firmware may use, under harsh flags: no warning, no
# foreign include, no foreign symbol, no data that changes.
# Usage: headers.sh SOURCE_DIR COMPILER... ; leaves nothing behind.
set -eu
source=$1; shift
include=$source/runtime/include
harsh='-std=c++17 -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Wpedantic -Werror'
harsh="$harsh -fno-exceptions -fno-rtti"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bad=0
fail() { echo "$*" >&2; bad=1; }

# What firmware compiles includes nothing of vectors/, and gnu.hpp in one place.
gates=$(cd "$include" && grep -l 'include "etlmon/\(vectors/\|gnu\)' etlmon/*.hpp \
  etlmon/temporal/* etlmon/distance/* | tr '\n' ' ')
[ "$gates" = 'etlmon/bits.hpp etlmon/views.hpp etlmon/distance/best.hpp ' ] ||
  fail "vectors/ or gnu.hpp is included by $gates"

for compiler in "$@"; do
  for header in $(cd "$include" && find etlmon -name '*.hpp'); do
    printf '#include "%s"\n#include "%s"\n' "$header" "$header" > "$work/alone.cpp"
    "$compiler" $harsh -O1 -I "$include" -c "$work/alone.cpp" -o "$work/alone.o" ||
      fail "$compiler: $header does not stand alone"
    case $header in etlmon/hosted/*) continue ;; esac
    "$compiler" $harsh -O1 -ffreestanding -I "$include" -c "$work/alone.cpp" -o "$work/alone.o" ||
      fail "$compiler: $header does not stand alone where there is no library"
    own='"etlmon/[a-z_/]+\.(hpp|inc)"|<(stdint|stddef|float|string|math)\.h>|needs C\+\+17'
    foreign=$(grep '^ *# *include' "$include/$header" | grep -v -E "$own") || true
    [ -z "$foreign" ] || fail "$header includes $foreign"
  done

  for flags in '-O0' '-Os' '-O2' '-O2 -ffreestanding' '-O3 -ffast-math' '-O2 -DETLMON_PORTABLE' \
    '-O2 -DETLMON_NO_DISPATCH' '-O2 -DWITH_ANGULAR'; do
    "$compiler" $harsh $flags -I "$include" -c "$source/tests/runtime/firmware_use.cpp" \
      -o "$work/use.o" || { fail "$compiler $flags: does not compile"; continue; }
    allowed='sqrtf|memcpy|memset|_GLOBAL_OFFSET_TABLE_'
    case $flags in
      *ANGULAR*) allowed="$allowed|atanf|__cpu_model" ;;
      *-ffreestanding* | *-DETLMON*) ;;
      *) allowed="$allowed|__cpu_model" ;;  # what the CPU has, asked by the compiler's library
    esac
    foreign=$(nm -u "$work/use.o" | awk '{ print $2 }' | grep -v -x -E "$allowed") || true
    [ -z "$foreign" ] || fail "$compiler $flags: refers to" $foreign
    changing=$(nm -C "$work/use.o" | grep -E ' [BbDdCcuV] ') || true
    [ -z "$changing" ] || fail "$compiler $flags: global data that may change: $changing"
  done
done
exit $bad
