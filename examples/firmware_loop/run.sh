#!/bin/sh
# run.sh OUT BOARD [PROGRAM]: runs a program of build.sh, loop, interrupts, recorder, why or
# retarget, in QEMU for an emulated board, and prints its output.
set -eu
out=$1 board=$2 program=${3:-loop}
name=$out/${board}_$program
emulate() {
    "$@" -nographic -monitor none -serial none -icount shift=0 \
        -chardev "file,id=text,path=$name.txt" \
        -semihosting-config enable=on,target=native,chardev=text -kernel "$name.elf" </dev/null
}
case $board in
host) "$name" >"$name.txt" ;;
cortex_m4) emulate qemu-system-arm -M mps2-an386 ;;
rv32) emulate qemu-system-riscv32 -M virt -bios none ;;
*) echo "run.sh: no board $board" >&2; exit 2 ;;
esac
cat "$name.txt"
