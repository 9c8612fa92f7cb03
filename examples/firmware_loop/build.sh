#!/bin/sh
# build.sh ETLC RUNTIME OUT BOARD...: compiles the specs to headers and the loop for each board, into the folder OUT.
# RUNTIME: the folder that holds etlmon/. BOARD: cortex_m4, rv32 (QEMU's mps2-an386 and virt machines), host.
set -eu
etlc=$1 runtime=$2 out=$3
shift 3
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$out"
for spec in grasp dock hover belt gauge; do
    "$etlc" "$here/$spec.etl" -o "$out/$spec.hpp"
done
includes="-I$here -I$out -I$runtime"
firmware="-std=c++17 -Wall -Wextra -Werror -Os -ffreestanding -fno-exceptions -fno-rtti -fno-math-errno -fno-threadsafe-statics
  -fno-asynchronous-unwind-tables -fstack-usage"
for board in "$@"; do
    source=$here/boards/$board
    case $board in
    host) "${CXX:-g++}" -std=c++17 -Wall -Wextra -Werror -O2 ${HOST_FLAGS:-} $includes "$here/loop.cpp" "$source.cpp" -o "$out/host" ;;
    cortex_m4)
        compile="arm-none-eabi-g++ -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard $firmware $includes"
        $compile -c "$here/loop.cpp" -o "$out/cortex_m4_loop.o"
        $compile -c "$source.cpp" -o "$out/cortex_m4_board.o"
        $compile -nostartfiles -T "$source.ld" "$out/cortex_m4_loop.o" "$out/cortex_m4_board.o" -lm -o "$out/cortex_m4.elf" ;;
    rv32)
        compile="riscv64-unknown-elf-g++ --specs=picolibc.specs -march=rv32imafc -mabi=ilp32f $firmware $includes"
        $compile -c "$here/loop.cpp" -o "$out/rv32_loop.o"
        $compile -c "$source.cpp" -o "$out/rv32_board.o"
        $compile -nostdlib -nostartfiles -T "$source.ld" -Wl,--no-warn-rwx-segments "$out/rv32_loop.o" "$out/rv32_board.o" -lm -lc -lgcc \
            -o "$out/rv32.elf" ;;
    *) echo "build.sh: no board $board" >&2; exit 2 ;;
    esac
done
