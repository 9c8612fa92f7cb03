#!/usr/bin/env bash
# stored_test.sh ETLC VALUES CXX FLAG...: a monitor with its target sets in a file gives the
# verdicts and telemetry of the same monitor with its sets in the header, bit for bit: every
# distance and aggregation, contrasts of searched sets, sets in every layout, the runtime included
# and pasted in. VALUES: robustness, or boolean, which measures distances on demand.
. "$(dirname "$0")/../box.bash"
etlc=$1 values=$2 cxx=$3
shift 3

"$cxx" -std=c++17 -O1 "$here/stored/arrays.cpp" -o arrays
./arrays wide.npy 1400 384   # more than 64 KiB: read in one stream
./arrays middle.npy 300 33
./arrays others.npy 420 33
./arrays narrow.npy 400 7
./arrays scalars.npy 300 2
./arrays map.npy 16 384
cat >stored.etl <<'END'
spec stored;
input wide : f32[384];
input middle : f32[33];
input narrow : f32[7];
input x : f32;
input y : f32;
target wide_set = load("wide.npy");
target middle_set = load("middle.npy");
target others = load("others.npy");
target narrow_set = load("narrow.npy");
target scalar_set = load("scalars.npy");
projection P = load("map.npy");
projection T = [[1, 2]] offset [0.25, 0];
END
predicates=
add() { echo "predicate $1 = $2 <= $3;" >>stored.etl; predicates+=" $1"; }
for metric in l2 l2sq l1 linf cosine angular; do add \
  "${metric}_middle" "min $metric(middle, middle_set)" 1; done
for metric in l2 l1 cosine; do add "${metric}_wide" "min $metric(wide, wide_set)" 1; done
add kth_wide "kth(5) l2(wide, wide_set)" 20
add mean_middle "mean l2(middle, middle_set)" 5
add max_middle "max cosine(middle, middle_set)" 1
add l2_narrow "min l2(narrow, narrow_set)" 1
add mean_narrow "mean angular(narrow, narrow_set)" 1
add weighted "min mahalanobis([1, 2, 3, 4, 5, 6, 7])(narrow, narrow_set)" 1
add l2_scalars "min l2([x, y], scalar_set)" 0.1
add form "min mahalanobis([[2, 1], [1, 3]])([x, y], scalar_set)" 0.1
add projected "min l2(P(wide), wide_set)" 5
add projected_scalars "mean l1(T([x, y]), scalar_set)" 1
: >names.inc
for p in $predicates; do echo "PREDICATE($p)" >>names.inc; done
contrast() {
  echo "predicate $1 = min $2(middle, middle_set) - min $2(middle, others) <= $3;" >>stored.etl
  echo "CONTRAST($1, middle_set, others)" >>names.inc
  predicates+=" $1"
}
contrast l2_contrast l2 0.5
contrast l2sq_contrast l2sq 0
contrast cosine_contrast cosine 0.1
echo "monitor touched = F (l2_wide && F (l2_middle || l2_narrow));" >>stored.etl
echo "monitor every = G ($(sed 's/^ //; s/ / || /g' <<<"$predicates"));" >>stored.etl
echo "sliding monitor none = F[0,2] !($(sed 's/^ //; s/ / \&\& /g' <<<"$predicates"));" >>stored.etl
echo 'MONITOR(touched) MONITOR(every) MONITOR(none)' >>names.inc
printf '#undef %s\n' PREDICATE CONTRAST MONITOR >>names.inc

options=(--values "$values" --max-code 10000000 --inline-targets)
"$etlc" stored.etl -o inlined.hpp --namespace inlined "${options[@]}" 100000000
"$etlc" stored.etl -o stored.hpp "${options[@]}" 0
grep -q 'inline constexpr float' inlined.hpp
[ "$(grep -c 'Search<420, 33>' stored.hpp)" = 3 ]  # so both sides of a contrast are searched
[ ! -e inlined.targets.bin ]
[ "$(wc -c <stored.hpp)" -lt 400000 ]
"$etlc" stored.etl -o pasted.hpp --standalone "${options[@]}" 0
cmp pasted.targets.bin stored.targets.bin
cat >pasted.cpp <<'END'
#include "pasted.hpp"
int main() {
  const etlmon::MappedTargets<stored::Targets> file("pasted.targets.bin");
  stored::Monitor monitor(file.targets());
  return monitor.ready() && monitor.step(stored::Inputs()).touched.unknown() ? 0 : 1;
}
END
flags=(-std=c++17 -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Wpedantic -Werror \
  -I. "-I$here/stored" "-I$runtime")
"$cxx" "${flags[@]}" -O1 -c "$here/stored/inlined.cpp" -o inlined.o
"$cxx" "${flags[@]}" "$@" "$here/stored/main.cpp" inlined.o -o compared
./compared stored.targets.bin
"$cxx" "${flags[@]}" -O1 -DETLMON_MAPPED_TARGETS pasted.cpp -o pasted
./pasted
