#!/usr/bin/env bash
# firmware_test.sh ETLC SOURCE CXX: the monitors of examples/firmware_loop on a Cortex-M4F and an
# RV32IMAFC in QEMU agree with the host: to the bit if the host adds in the same order, else within
# the stated bounds. Their objects have only the allowed library symbols, no exception tables, no
# initialised data, and code within its limit. Interrupts at any instruction of a step change
# nothing.
set -euo pipefail
etlc=$1 source=$2 cxx=$3
loop=$source/examples/firmware_loop
runtime=$source/runtime/include
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT
fail() { echo "FAILED: $*"; exit 1; }

sh "$loop/build.sh" "$etlc" "$runtime" "$box" cortex_m4 rv32
CXX=$cxx sh "$loop/build.sh" "$etlc" "$runtime" "$box" host
for board in cortex_m4 rv32 host; do
    timeout 120 sh "$loop/run.sh" "$box" "$board" >/dev/null
done
"$cxx" -std=c++17 -O1 -I "$runtime" "$source/tests/firmware/compare.cpp" -o "$box/compare"
for board in cortex_m4 rv32; do
    "$box/compare" "$box/${board}_loop.txt" "$box/host_loop.txt" ||
        fail "$board and the host differ"
done
verdicts() { grep -v instructions "$1"; }
cmp <(verdicts "$box/cortex_m4_loop.txt") <(verdicts "$box/rv32_loop.txt") ||
    fail "the boards differ"
if [ "$(uname -m)" = x86_64 ] &&
    grep -qw fma /proc/cpuinfo; then  # scalars, one sum per row, fused, like the boards
    CXX=$cxx HOST_FLAGS="-DETLMON_PORTABLE -mfma" \
        sh "$loop/build.sh" "$etlc" "$runtime" "$box" host
    sh "$loop/run.sh" "$box" host >/dev/null
    cmp <(verdicts "$box/cortex_m4_loop.txt") <(verdicts "$box/host_loop.txt") ||
        fail "the boards and a host without vectors differ"
fi

# The same monitors with the portable runtime in the file give the same verdicts, to the bit.
ETLC_OPTIONS=--standalone sh "$loop/build.sh" "$etlc" "$box/none" "$box/alone" cortex_m4 rv32
for board in cortex_m4 rv32; do
    timeout 120 sh "$loop/run.sh" "$box/alone" "$board" >/dev/null
    cmp <(verdicts "$box/alone/${board}_loop.txt") <(verdicts "$box/${board}_loop.txt") ||
        fail "$board: the portable runtime answers otherwise"
    grep instructions "$box/alone/${board}_loop.txt" | sed 's/^/standalone: /' || true
done

# A timer interrupt judges the measurements of the loop, and fills its inputs. Every verdict equals
# that of a run without interrupts.
for board in cortex_m4 rv32; do
    timeout 120 sh "$loop/run.sh" "$box" "$board" interrupts
    awk '$2 == "000007d0" && $3 > "00000064" && $4 == "00000000" { good++ }
         END { exit good != 2 || NR != 2 }' "$box/${board}_interrupts.txt" ||
        fail "$board: interrupts change verdicts, or hardly any came during a step"
done

# The deciding samples are the same, their distances to the bit.
for board in cortex_m4 rv32; do
    timeout 120 sh "$loop/run.sh" "$box" "$board" why >/dev/null
done
cmp "$box/cortex_m4_why.txt" "$box/rv32_why.txt" || fail "the boards explain otherwise"
if [ "$(uname -m)" = x86_64 ] && grep -qw fma /proc/cpuinfo; then
    sh "$loop/run.sh" "$box" host why >/dev/null
    cmp "$box/cortex_m4_why.txt" "$box/host_why.txt" || fail "the host explains otherwise"
fi
for name in aligned level called; do
    grep -q "^$name " "$box/rv32_why.txt" || fail "no verdict is decided by $name"
done

# Other parameters, first on trial and then active: the same lines everywhere, and every damaged
# page is refused.
for board in cortex_m4 rv32; do
    timeout 120 sh "$loop/run.sh" "$box" "$board" retarget >/dev/null
done
cmp "$box/cortex_m4_retarget.txt" "$box/rv32_retarget.txt" || fail "the boards retarget otherwise"
if [ "$(uname -m)" = x86_64 ] && grep -qw fma /proc/cpuinfo; then
    sh "$loop/run.sh" "$box" host retarget >/dev/null
    cmp "$box/cortex_m4_retarget.txt" "$box/host_retarget.txt" ||
        fail "the host retargets otherwise"
fi
awk '$1 == "parameters" { $2 == "00000000" ? taken++ : refused++ }
     $1 == "trial" && $2 == "00000050" && $3 > "00000000" && $4 > "00000000" { differing++ }
     END { exit taken != 1 || refused < 10 || differing != 2 }' "$box/rv32_retarget.txt" ||
    fail "damage was taken, or the trial found nothing"

# The flight recorder writes the same bytes everywhere, and etlc incident reads them.
for board in cortex_m4 rv32; do
    timeout 120 sh "$loop/run.sh" "$box" "$board" recorder >/dev/null
done
cmp "$box/cortex_m4_recorder.txt" "$box/rv32_recorder.txt" || fail "the boards record otherwise"
if [ "$(uname -m)" = x86_64 ] && grep -qw fma /proc/cpuinfo; then
    sh "$loop/run.sh" "$box" host recorder >/dev/null
    cmp "$box/cortex_m4_recorder.txt" "$box/host_recorder.txt" || fail "the host records otherwise"
fi
for incident in 0 1 2 3; do
    awk -v n="0000000$incident" '$1 == "incident" && $2 == n { print $3 }' \
        "$box/rv32_recorder.txt" | sed 's/../\\x&/g' | tr -d '\n' >"$box/bytes"
    printf "$(cat "$box/bytes")" >"$box/incident"
    "$etlc" incident "$box/incident" --spec "$loop/dock.etl" >"$box/incident.txt"
    grep -q "^incident $incident of dock, episode [0-7]: alarm of " "$box/incident.txt" ||
        fail "incident $incident is about something else"
done

# Each monitor alone, as a program would compile it.
objects() {  # PREFIX FLAG...: lists symbols and sections of a monitor's object
    local prefix=$1
    shift
    for spec in grasp dock hover belt gauge sort drift dock_retargetable; do
        cat >"$box/$spec.cpp" <<END
#include "$spec.hpp"
$spec::Verdicts step(${spec}::Monitor& m, const $spec::Inputs& in);
$spec::Verdicts step(${spec}::Monitor& m, const $spec::Inputs& in) { return m.step(in); }
void reset(${spec}::Monitor& m);
void reset(${spec}::Monitor& m) { m.reset(); }
END
        "${prefix}g++" "$@" -std=c++17 -Os -ffreestanding -fno-exceptions -fno-rtti \
            -fno-math-errno -fno-asynchronous-unwind-tables \
            -fstack-usage -I "$box" -I "$runtime" -c "$box/$spec.cpp" -o "$box/$spec.o"
        foreign=$("${prefix}nm" -u "$box/$spec.o" | awk '{ print $2 }' |
            grep -v -x -E 'sqrtf|memcpy|memset|atanf') || true
        [ -z "$foreign" ] || fail "$prefix$spec refers to" $foreign
        ! "${prefix}objdump" -h "$box/$spec.o" | grep -E 'gcc_except_table|ARM.extab|eh_frame' ||
            fail "$prefix$spec has exception tables"
        ! "${prefix}nm" "$box/$spec.o" | grep -E ' [BbDdCc] ' ||
            fail "$prefix$spec has data that changes"
        read -r text constants <<<"$("${prefix}size" -A "$box/$spec.o" | awk '
            $1 ~ /^\.text/ { t += $2 } $1 ~ /^\.s?rodata/ { c += $2 } END { print t + 0, c + 0 }')"
        state=$(sed -n 's/.*kStateBytes = \([0-9]*\);.*/\1/p
                        s/.*kStateBytes = .*with_pointer(\([0-9]*\)).*/\1 + 4/p' "$box/$spec.hpp")
        stack=$(awk '{ if ($(NF - 1) > most) most = $(NF - 1) } END { print most }' "$box/$spec.su")
        printf '%-22s %-17s code %5d  constants %5d  state %4d  deepest frame %4d\n' "$prefix" \
            "$spec" "$text" "$constants" "$((state))" "$stack"
    done
}
objects riscv64-unknown-elf- --specs=picolibc.specs -march=rv32imafc -mabi=ilp32f
objects arm-none-eabi- -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard
grep instructions "$box/rv32_loop.txt"

# The cost of changing parameters: checking and switching.
cat >"$box/take.cpp" <<'END'
#include "dock_retargetable.hpp"
using dock_retargetable::Monitor;
etlmon::ParamsState take(Monitor& m, const uint8_t* bytes, size_t size);
etlmon::ParamsState take(Monitor& m, const uint8_t* bytes, size_t size) {
    return m.retarget(bytes, size, etlmon::Past::kept);
}
END
arm-none-eabi-g++ -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -std=c++17 -Os \
    -ffreestanding -fno-exceptions -fno-rtti -fno-math-errno -fno-asynchronous-unwind-tables \
    -fstack-usage -I "$box" -I "$runtime" -c "$box/take.cpp" -o "$box/take.o"
taking=$(arm-none-eabi-size -A "$box/take.o" | awk '$1 ~ /^\.text/ { t += $2 } END { print t }')
frame=$(awk '{ if ($(NF - 1) > most) most = $(NF - 1) } END { print most }' "$box/take.su")
echo "retarget() on a Cortex-M4F: $taking bytes, deepest frame $frame"
foreign=$(arm-none-eabi-nm -u "$box/take.o" | awk '{ print $2 }' | grep -v -x -E 'memcpy|memset') ||
    true
[ -z "$foreign" ] && [ "$taking" -le 1600 ] ||
    fail "retarget() has more code than its limit, or refers to" $foreign

# One predicate of 4 x 384, a scalar one, F (a && F b), bounds and telemetry: the instructions of a
# step, and beside it the code only for a missing embedding and for distances that overflow,
# underflow or are exactly 0.
read -r step reset rare <<<"$(arm-none-eabi-nm -S -C --radix=d "$box/grasp.o" | awk '
    $3 !~ /[tTwW]/ { next }
    $4 ~ /^reset/ { r += $2; next }
    /measure_again|Rescaled|all_finite/ { c += $2; next }
    { s += $2 }
    END { print s, r, c }')"
echo "grasp on a Cortex-M4F: step $step bytes, reset $reset, rare cases $rare"
[ "$step" -le 424 ] && [ "$reset" -le 48 ] && [ "$rare" -le 360 ] || fail "more code than its limit"
