#!/bin/sh
# run.sh OUT BOARD: runs what build.sh made, in QEMU where the board is one, and prints what the loop writes.
set -eu
out=$1 board=$2
text=$out/$board.txt
emulate() {
    "$@" -nographic -monitor none -serial none -icount shift=0 -chardev "file,id=text,path=$text" \
        -semihosting-config enable=on,target=native,chardev=text -kernel "$out/$board.elf" </dev/null
}
case $board in
host) "$out/host" >"$text" ;;
cortex_m4) emulate qemu-system-arm -M mps2-an386 ;;
rv32) emulate qemu-system-riscv32 -M virt -bios none ;;
*) echo "run.sh: no board $board" >&2; exit 2 ;;
esac
cat "$text"
