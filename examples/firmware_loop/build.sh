#!/bin/sh
# build.sh ETLC RUNTIME OUT BOARD...: compiles the specs to headers and the programs for each board,
# into the folder OUT. RUNTIME: the folder with etlmon/, unless ETLC_OPTIONS is --standalone. BOARD:
# cortex_m4, rv32 (QEMU's mps2-an386 and virt machines), host.
set -eu
etlc=$1 runtime=$2 out=$3
shift 3
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$out"
for spec in grasp dock hover belt gauge sort drift; do
    "$etlc" "$here/$spec.etl" ${ETLC_OPTIONS:-} -o "$out/$spec.hpp"
done
"$etlc" "$here/dock.etl" ${ETLC_OPTIONS:-} --recorder 5,3,4 --namespace dock_recorded \
    -o "$out/dock_recorded.hpp"
"$etlc" "$here/dock.etl" ${ETLC_OPTIONS:-} --explain --namespace dock_why -o "$out/dock_why.hpp"
"$etlc" "$here/dock.etl" ${ETLC_OPTIONS:-} --retargetable --namespace dock_retargetable \
    -o "$out/dock_retargetable.hpp"
"$etlc" "$here/dock_moved.etl" --emit params -o "$out/dock_moved.params.bin"
includes="-I$here -I$out -I$runtime"
firmware="-std=c++17 -Wall -Wextra -Werror -Os -ffreestanding -fno-exceptions -fno-rtti
  -fno-math-errno -fno-threadsafe-statics -fno-asynchronous-unwind-tables -fstack-usage"
cortex_m4="arm-none-eabi-g++ -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard
  $firmware $includes"
rv32="riscv64-unknown-elf-g++ --specs=picolibc.specs -march=rv32imafc -mabi=ilp32f
  $firmware $includes"
for board in "$@"; do
    source=$here/boards/$board
    for program in loop interrupts recorder why retarget; do
        sources="$here/$program.cpp $source.cpp" image=$out/${board}_$program
        case $board in
        host) "${CXX:-g++}" -std=c++17 -Wall -Wextra -Werror \
            -O2 ${HOST_FLAGS:-} $includes $sources -o "$image" ;;
        cortex_m4) $cortex_m4 -nostartfiles -T "$source.ld" $sources -lm -o "$image.elf" ;;
        rv32) $rv32 -nostdlib -nostartfiles -T "$source.ld" -Wl,--no-warn-rwx-segments $sources \
            -lm -lc -lgcc -o "$image.elf" ;;
        *) echo "build.sh: no board $board" >&2; exit 2 ;;
        esac
    done
done
