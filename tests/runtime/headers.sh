#!/bin/sh
# Compiles every runtime header alone, and everything that firmware may use, with strict flags: no
# warning, no foreign include, no foreign symbol, no mutable data.
# Usage: headers.sh SOURCE_DIR COMPILER... ; it leaves no files.
set -eu
source=$1; shift
include=$source/runtime/include
harsh='-std=c++17 -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Wpedantic -Werror'
harsh="$harsh -fno-exceptions -fno-rtti"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bad=0
fail() { echo "$*" >&2; bad=1; }

# Firmware code includes nothing of vectors/, and gnu.hpp in one place.
gates=$(cd "$include" && grep -l 'include "etlmon/\(vectors/\|gnu\)' etlmon/*.hpp \
  etlmon/temporal/* etlmon/past/* etlmon/distance/* | tr '\n' ' ')
[ "$gates" = 'etlmon/bits.hpp etlmon/views.hpp etlmon/distance/best.hpp ' ] ||
  fail "vectors/ or gnu.hpp is included by $gates"

headers=$(cd "$include" && find etlmon -name '*.hpp' | sort)
own='"etlmon/[a-z_/]+\.(hpp|inc)"|<(stdint|stddef|float|string|math)\.h>|needs C\+\+17'
mkdir "$work/hosted" "$work/freestanding"
for header in $headers; do
  alone=$(echo "$header" | tr / _)
  alone=hosted/${alone%.hpp}.cpp
  printf '#include "%s"\n#include "%s"\n' "$header" "$header" > "$work/$alone"
  case $header in etlmon/hosted/*) continue ;; esac
  cp "$work/$alone" "$work/freestanding"
  foreign=$(grep '^ *# *include' "$include/$header" | grep -v -E "$own") || true
  [ -z "$foreign" ] || fail "$header includes $foreign"
done

for compiler in "$@"; do
  # Nothing calls their definitions, so no code is generated.
  "$compiler" $harsh -O1 -I "$include" -fsyntax-only "$work"/hosted/*.cpp ||
    fail "$compiler: a header does not stand alone"
  "$compiler" $harsh -O1 -ffreestanding -I "$include" -fsyntax-only "$work"/freestanding/*.cpp ||
    fail "$compiler: a header does not stand alone where there is no library"

  # Without optimisation, for size, for speed, and with -ffast-math; all versions of the kernels,
  # one, and the one for firmware.
  for flags in '-O0' '-Os' '-O2 -DWITH_ANGULAR' '-O2 -ffreestanding' '-O2 -ffast-math' \
    '-Os -DETLMON_PORTABLE'; do
    "$compiler" $harsh $flags -I "$include" -c "$source/tests/runtime/firmware_use.cpp" \
      -o "$work/use.o" || { fail "$compiler $flags: does not compile"; continue; }
    allowed='sqrtf|memcpy|memset|_GLOBAL_OFFSET_TABLE_'
    case $flags in
      *ANGULAR*) allowed="$allowed|atanf|__cpu_model" ;;
      *-ffreestanding* | *-DETLMON*) ;;
      *) allowed="$allowed|__cpu_model" ;;  # features of the CPU, from the compiler's library
    esac
    foreign=$(nm -u "$work/use.o" | awk '{ print $2 }' | grep -v -x -E "$allowed") || true
    [ -z "$foreign" ] || fail "$compiler $flags: refers to" $foreign
    changing=$(nm -C "$work/use.o" | grep -E ' [BbDdCcuV] ') || true
    [ -z "$changing" ] || fail "$compiler $flags: global data that may change: $changing"
  done
done
exit $bad
