#!/usr/bin/env bash
# retarget_test.sh ETLC CXX FLAG...: a class made with --retargetable measures like a plain class
# with the same numbers, to the bit, and takes other parameters between steps: a kept past is judged
# like a plain class that reads the same robustness from scalars, a forgotten one like a new
# monitor. Damaged and foreign parameters are refused and change nothing. A shadow counts the
# differences of two monitors side by side.
. "$(dirname "$0")/../box.bash"
etlc=$1 cxx=$2
shift 2

"$cxx" -std=c++17 -O1 "$here/stored/arrays.cpp" -o arrays
for seed in 1 2; do
  mkdir $seed
  ./arrays $seed/bay.npy 3 32 $seed
  ./arrays $seed/wall.npy 20 7 $seed      # in columns, in a plain class
  ./arrays $seed/many.npy 300 33 $seed
  ./arrays $seed/map.npy 4 32 $seed
done
monitors='
monitor reach = F at_bay;
monitor avoid = G !at_wall;
monitor both = F (at_bay && F among) && G (open -> !at_wall);
monitor answered = G (called && through -> F[0,6] weighted);
monitor nested = G (at_wall -> F[1,4] (formed && F[0,3] apart));
monitor pending = G F[0,5] (among U through);
monitor held = G (at_bay S weighted);
restartable monitor again = F[2,9] at_wall;
repeating monitor cycle = F among;
sliding monitor slid = F[0,5] (at_bay || O[0,4] apart);
sliding monitor sought = among U[1,4] at_bay;
'
unnamed='monitor charged = G (charge > LIMIT);
sliding monitor level = G[0,3] (charge * GAIN <= 1.25);
'
spec() {  # SEED NEAR LIMIT GAIN WEIGHT ENDING
  cat <<SPEC
spec docking;
const near = $2;
const limit = $3;
const gain = $4;
input z : f32[32];
input w : f32[7];
input v : f32[33];
input x : f32;
input y : f32;
input charge : f32 in [0, 2];
input open : bool;
input called : bool hold 2;
target bay = load("bay.npy");
target wall = load("wall.npy");
target many = load("many.npy");
target origin = [[0, 0], [$4, 1]];
projection P = load("map.npy");
predicate at_bay = min l2(z, bay) <= near;
predicate at_wall = min cosine(w, wall) <= 0.$1;
predicate among = kth(5) l1(v, many) <= 3$1;
predicate apart = min l2(z, bay) - gain * mean angular(z, bay) >= 0.1;
predicate weighted = min mahalanobis([$5, 2, 3, 4, 5, 6, 7])(w, wall) <= 1$1;
predicate formed = max mahalanobis([[$4, 0.5], [0.5, $5]])([x, y], origin) < 2.$1;
predicate through = min linf(P(z), bay) <= 1$1;
$monitors
SPEC
  sed "s/LIMIT/limit/; s/GAIN/gain/" <<<"$unnamed"
}
spec 1 7.5 0.5 1.5 1 >1/docking.etl
spec 2 8.5 0.25 2.5 3 >2/docking.etl
"$etlc" 1/docking.etl --retargetable -o docking.hpp
"$etlc" 1/docking.etl --namespace first -o first.hpp
"$etlc" 2/docking.etl --namespace second -o second.hpp

# Parameters beside the header equal those of --emit params, on every call. With other numbers the
# class is the same except for its comments.
"$etlc" 1/docking.etl --emit params -o first.bin
cmp first.bin docking.params.bin || fail "two kinds of parameters"
head=$(sed -n '/^#pragma/q; s,^//,,p' docking.hpp | tr -d '\n' | tr -s ' ')
grep -q "in a block of $(wc -c <first.bin) bytes" <<<"$head" ||
  fail "the head states other bytes"
"$etlc" 2/docking.etl --emit params -o second.bin
! cmp -s first.bin second.bin || fail "other numbers have the same parameters"
"$etlc" 2/docking.etl --retargetable -o other.hpp
code() { sed 's,//.*,,; s, *$,,; /^$/d' "$1"; }
cmp <(code docking.hpp) <(code other.hpp) || fail "a number stands in the class"
"$etlc" 1/docking.etl --set near=8.25 --emit params >third.bin
"$etlc" 1/docking.etl --retargetable --namespace a::b --standalone -o pasted.hpp
cmp pasted.params.bin docking.params.bin || fail "parameters depend on the namespace"
# Another shape: a longer window.
sed 's/F\[0,6\]/F[0,7]/' 1/docking.etl >1/longer.etl
"$etlc" 1/longer.etl --emit params -o longer.bin

# The same formulas over scalars that hold each predicate's robustness.
{
  echo "spec twin;"
  echo "input open : bool;"
  echo "input called : bool hold 2;"
  for p in at_bay at_wall among apart weighted formed through comparison_1 comparison_2; do
    echo "input of_$p : f32; predicate $p = of_$p >= 0;"
    echo "PREDICATE($p)" >>predicates.inc
  done
  echo "$monitors"
  sed "s/(charge > LIMIT)/comparison_1/; s/(charge \* GAIN <= 1.25)/comparison_2/" <<<"$unnamed"
} >twin.etl
"$etlc" twin.etl -o twin.hpp

for file in first second third longer; do
  { echo "alignas(64) inline const unsigned char ${file}_bytes[] = {"
    od -An -v -tu1 "$file.bin" | tr -s ' ' , | sed 's/^,//; s/$/,/'
    echo "};"; } >"$file.inc"
done
flags=(-std=c++17 -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Wpedantic -Werror \
  -I. "-I$runtime")
"$cxx" "${flags[@]}" "$@" "$here/retarget/main.cpp" -o program
./program
cat >pasted.cpp <<'PROGRAM'
#include "pasted.hpp"
int main() {
  a::b::Shadow shadow;
  return shadow.step(a::b::Inputs()).reach.unknown() ? 0 : 1;
}
PROGRAM
"$cxx" -std=c++17 -Wall -Wextra -Wconversion -Wshadow -Wpedantic -Werror pasted.cpp -o pasted
./pasted

# The class's own names are free for a spec.
cat >thresholds.etl <<'SPEC'
spec thresholds;
input numbers : f32[2];
input params, constants : f32;
input shadow : bool;
target targets = [[1, 2], [3, 4]];
target layout = [[1, 0]];
projection projections = [[1, 2]] offset [1, 1];
predicate ready = min l2(numbers, targets) - 2 * min l2(numbers, layout) <= 1;
predicate unseen = cosine(numbers, layout) <= 1;
predicate origin = params + 2.5 * constants > 3;
predicate retarget = min l2(projections(numbers), targets) <= 1;
let unknown = ready && unseen;
monitor past = F unknown;
monitor monitor_of = G (origin || retarget -> shadow);
SPEC
"$etlc" thresholds.etl --retargetable --lets -o thresholds.hpp
cat >words.cpp <<'PROGRAM'
#include "thresholds.hpp"
int main() { return thresholds::Shadow().step(thresholds::Inputs()).past.alarm() ? 1 : 0; }
PROGRAM
"$cxx" "${flags[@]}" words.cpp -o words
./words

# etlc run --retargetable gives the verdicts of such a class.
cat >brief.etl <<'SPEC'
spec brief;
input x : f32 in [0, 4];
input y : f32 in [0, 4];
monitor reach = F x > 3;
monitor within = G (x > 1 -> F[0,2] y <= 0.5);
sliding monitor both = F[0,1] (x > 2 && y > 2);
SPEC
printf 'x,y\n0.5,3\n1.5,\n2.25,2.5\n,4\n0.5,0.25\n3.5,1\n' >brief.csv
"$etlc" brief.etl --retargetable -o brief.hpp
od -An -v -tu1 brief.params.bin | tr -s ' ' , | sed 's/^,//; s/$/,/' >brief.inc
cat >brief.cpp <<'PROGRAM'
#include <cstdio>
#include "brief.hpp"
alignas(64) static const unsigned char numbers[] = {
#include "brief.inc"
};
int main() {
  const float none = etlmon::kMissing;
  const float trace[][2] = {{0.5F, 3}, {1.5F, none}, {2.25F, 2.5F}, {none, 4}, {0.5F, 0.25F},
                            {3.5F, 1}};
  brief::Monitor monitor(brief::Params(numbers, sizeof numbers));
  int step = 0;
  for (const auto& now : trace) {
    for (const auto& [name, v] : named(monitor.step({now[0], now[1]})))
      if (v.decided())
        std::printf("%d,%s,%.9g,%.9g,%.9g\n", step, name, static_cast<double>(v.lower),
                    static_cast<double>(v.robustness), static_cast<double>(v.upper));
    ++step;
  }
}
PROGRAM
"$cxx" "${flags[@]}" brief.cpp -o brief
"$etlc" run brief.etl --retargetable --trace brief.csv | grep -v undecided | cut -d, -f1-5 |
  tail -n +2 >brief.run
./brief >brief.class
grep -q inf brief.run
cmp brief.run brief.class || { diff brief.run brief.class; fail "etlc run says otherwise"; }
