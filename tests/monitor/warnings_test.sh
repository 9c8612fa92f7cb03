#!/usr/bin/env bash
# warnings_test.sh ETLC GXX CLANGXX: generated headers and the runtime are silent under every common
# warning, with macros named min and max (windows.h), and in a program that has a global of every
# name in them.
set -euo pipefail
etlc=$1 gxx=$2 clangxx=$3
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }

cat >"$box/use.cpp" <<'END'
#include "globals.hpp"
#define min(a, b) macro_min_is_called
#define max(a, b) macro_max_is_called
#include "monitor.hpp"
used::Verdicts step_once(used::Monitor& used_monitor, const used::Inputs& used_in);
used::Verdicts step_once(used::Monitor& used_monitor, const used::Inputs& used_in) {
  return used_monitor.step(used_in);
}
etlmon::Flag flag_of(bool used_on);
etlmon::Flag flag_of(bool used_on) { return used_on; }
#ifdef VIEWED
struct ThreeFloats {
  float elements[3];
  constexpr const float* data() const { return elements; }
  constexpr size_t size() const { return 3; }
};
etlmon::Vector<float, 3> view_of(const ThreeFloats& used_floats);
etlmon::Vector<float, 3> view_of(const ThreeFloats& used_floats) { return used_floats; }
#endif
#ifdef RECORDED
bool write_first(const used::Monitor& used_monitor, void (*used_sink)(const uint8_t*, size_t));
bool write_first(const used::Monitor& used_monitor, void (*used_sink)(const uint8_t*, size_t)) {
  return used_monitor.write_incident(0, used_sink);
}
#endif
#ifdef RETARGETED
used::Shadow shadow_of(const uint8_t* used_bytes, size_t used_size);
used::Shadow shadow_of(const uint8_t* used_bytes, size_t used_size) {
  return used::Shadow(used::Monitor(used::Params(used_bytes, used_size)));
}
#endif
#ifdef STORED
used::Monitor monitor_of(const uint8_t* used_bytes, size_t used_size);
used::Monitor monitor_of(const uint8_t* used_bytes, size_t used_size) {
  return {used_bytes, used_size};
}
#endif
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
# Declares a global of every name in the runtime and in monitor.hpp, but for keywords, types, names
# of the C library, and those that begin with etlmon: g++ -Wshadow compares parameters of
# constructors, and of lambdas in templates, with globals, so theirs do.
globals() {
    cat "$source"/runtime/include/etlmon/*.hpp "$source"/runtime/include/etlmon/*/*.{hpp,inc} \
        "$box/monitor.hpp" | sed 's|//.*||; /^ *#/d; s/"[^"]*"//g' |
        grep -oE '\b[A-Za-z_][A-Za-z_0-9]*' | grep -vE '^(etlmon|ETLMON|_)|_t$|_(MAX|MIN)$' |
        grep -vxF "$(tr -s ' ' '\n' <<<"$reserved")" | LC_ALL=C sort -u |
        sed 's/.*/extern int &;/' >"$box/globals.hpp"
    [ "$(wc -l <"$box/globals.hpp")" -gt 1000 ] || fail "no names"
    defined=()
    ! grep -q 'etlmon::Vector<' "$box/monitor.hpp" || defined+=(-DVIEWED)
    ! grep -q 'bool write_incident' "$box/monitor.hpp" || defined+=(-DRECORDED)
    ! grep -q 'using Shadow = ' "$box/monitor.hpp" || defined+=(-DRETARGETED)
    ! grep -q 'using Targets = ' "$box/monitor.hpp" || defined+=(-DSTORED)
}
reserved='alignas alignof auto bool break case char class const const_cast constexpr continue
  decltype default delete do double else enum explicit extern false float for friend if inline int
  long namespace new noexcept nullptr operator private public return short signed sizeof static
  static_assert static_cast struct switch template this true typename union unsigned using void
  volatile while mutable protected reinterpret_cast used asm min max
  typedef memcpy atanf sqrt sqrtf log free'
# clang++ warns before it generates code, g++ also while it optimises.
silent() {  # COMPILER WARNING...
    local code=(-c -o "$box/use.o")
    [ "$1" != "$clangxx" ] || code=(-fsyntax-only)
    "$@" "${defined[@]}" -std=c++17 -O2 -Werror -I "$source/runtime/include" -I "$box" \
        "${code[@]}" "$box/use.cpp" || fail "$1 warns of $spec, $values, targets as $targets"
}

spec=examples/firmware_loop/gauge.etl values=--retargetable targets=f32
"$etlc" "$source/$spec" --retargetable --namespace used -o "$box/monitor.hpp"
globals
silent "$gxx" "${gcc_warnings[@]}"
silent "$clangxx" "${clang_warnings[@]}"
while read -r spec targets options; do
    for values in "--values robustness" "--values boolean" --explain; do
        "$etlc" "$source/$spec" $values --targets-as "$targets" --namespace used \
            $options -o "$box/monitor.hpp" 2>/dev/null
        globals
        silent "$gxx" "${gcc_warnings[@]}"
        silent "$clangxx" "${clang_warnings[@]}"
    done
done <<'END'
examples/dubins/dubins.etl f32
examples/firmware_loop/grasp.etl i8 --standalone
examples/firmware_loop/gauge.etl f32 --inline-targets 0
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
globals
silent "$gxx" -ffast-math "${gcc_warnings[@]}"
