#!/usr/bin/env bash
# warnings_test.sh ETLC GXX CLANGXX: generated headers and the runtime are silent under every common
# warning, and with macros named min and max (windows.h).
set -euo pipefail
etlc=$1 gxx=$2 clangxx=$3
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }

cat >"$box/use.cpp" <<'END'
#define min(a, b) macro_min_is_called
#define max(a, b) macro_max_is_called
#include "monitor.hpp"
used::Verdicts step_once(used::Monitor& monitor, const used::Inputs& in);
used::Verdicts step_once(used::Monitor& monitor, const used::Inputs& in) {
  return monitor.step(in);
}
#undef min
#undef max
END
gcc_warnings=(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wfloat-equal
    -Wdouble-promotion -Wuseless-cast -Wold-style-cast -Wcast-align=strict -Wcast-qual
    -Wduplicated-cond -Wduplicated-branches -Wlogical-op -Wnull-dereference -Wundef
    -Wredundant-decls -Wswitch-enum -Wzero-as-null-pointer-constant)
# All warnings of clang++, except those listed in docs/generated_code.md.
clang_warnings=(-Weverything -Wno-c++98-compat -Wno-c++98-compat-pedantic
    -Wno-c++98-compat-local-type-template-args -Wno-pre-c++14-compat -Wno-pre-c++17-compat
    -Wno-padded -Wno-unused-macros)
silent() {  # COMPILER WARNING...
    "$@" -std=c++17 -O2 -Werror -I "$source/runtime/include" -I "$box" -c "$box/use.cpp" \
        -o "$box/use.o" || fail "$1 warns of $spec, $values, targets as $targets"
}

spec=examples/firmware_loop/gauge.etl values=--retargetable targets=f32
"$etlc" "$source/$spec" --retargetable --namespace used -o "$box/monitor.hpp"
silent "$gxx" "${gcc_warnings[@]}"
silent "$clangxx" "${clang_warnings[@]}"
while read -r spec targets options; do
    for values in "--values robustness" "--values boolean" --explain; do
        "$etlc" "$source/$spec" $values --targets-as "$targets" --namespace used \
            $options -o "$box/monitor.hpp" 2>/dev/null
        silent "$gxx" "${gcc_warnings[@]}"
        silent "$clangxx" "${clang_warnings[@]}"
    done
done <<'END'
examples/dubins/dubins.etl f32
examples/firmware_loop/grasp.etl i8
tests/monitor/demand.etl f32 --recorder 4,2,2
tests/spec/ok/adaptive.etl f32 --recorder 0,0,1
tests/spec/ok/inputs.etl i8
tests/monitor/cases/pending.etl f32
tests/monitor/cases/shared.etl f32
END

# A matrix smaller than the 16 elements that kernels read at once, under the assumption of no NaN.
spec='a projection of two scalars' values=-ffast-math targets=f32
cat >"$box/small.etl" <<'ETL'
spec small;
input x, y : f32;
projection turned = [[1, 2], [0.5, -1], [3, 1]];
target corners = [[1, 2, 3], [0, 0, 1]] of turned([x, y]);
predicate near = min l2(turned([x, y]), corners) <= 1;
monitor reach = F near;
ETL
"$etlc" "$box/small.etl" --namespace used -o "$box/monitor.hpp"
silent "$gxx" -ffast-math "${gcc_warnings[@]}"
