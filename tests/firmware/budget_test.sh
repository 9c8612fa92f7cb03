#!/usr/bin/env bash
# budget_test.sh ETLC SOURCE CXX: `state B` and `targets B` in the head of a generated header equal
# the figures of nm for an object, on x86-64, Cortex-M4F and RV32IMAFC.
. "$(dirname "$0")/../box.bash"
etlc=$1 source=$2 cxx=$3
runtime=$source/runtime/include

"$cxx" -std=c++17 -O1 "$source/tests/monitor/stored/arrays.cpp" -o arrays
./arrays long.npy 128 64
./arrays short.npy 5 2
./arrays few.npy 3 48
./arrays rows.npy 40 7
./arrays many.npy 300 33
./arrays map.npy 5 33

cat >scalars.etl <<'END'
spec scalars;
input x : f32 hold 3;
input open : bool;
monitor seen = F (x < 1 && open);
monitor held = G (O[0, 20] (x > 2) || open);
sliding monitor soon = F[0, 9] (x < 1);
END
cat >two_distances.etl <<'END'
spec two_distances;
input z : f32[64];
target goal = load("long.npy");
predicate near = min l2(z, goal) <= 1;
monitor reach = F (near && min cosine(z, goal) <= 0.5);
END
cat >padded.etl <<'END'
spec padded;
input x : f32;
input y : f32;
target goal = load("short.npy");
predicate near = min l2([x, y], goal) <= 1;
predicate there = max l1([x, y], goal) <= 1;
predicate ahead = mean cosine([x, y], goal) <= 0.5;
monitor reach = F (near && there);
monitor turn = F ahead;
END
cat >narrow.etl <<'END'
spec narrow;
input z : f32[64];
input r : f32[7];
target goal = load("long.npy");
target rows = load("rows.npy");
predicate near = min l2(z, goal) <= 1;
predicate ahead = min angular(r, rows) <= 0.5;
predicate there = kth(2) l1(r, rows) <= 2;
monitor reach = F (near && (ahead || there));
END
cat >weighted.etl <<'END'
spec weighted;
input z : f32[7];
target rows = load("rows.npy");
predicate scaled = min mahalanobis([1, 2, 3, 4, 5, 6, 7])(z, rows) <= 1;
predicate near = min l2(z, rows) <= 1;
monitor reach = F scaled && F near;
END
cat >quadratic.etl <<'END'
spec quadratic;
input z : f32[2];
target rows = load("short.npy");
predicate turned = min mahalanobis([[2, 1], [1, 2]])(z, rows) <= 1;
predicate near = min l2(z, rows) <= 1;
monitor reach = F turned && F near;
END
cat >searched.etl <<'END'
spec searched;
input z : f32[33];
input r : f32[48];
target goal = load("many.npy");
target few = load("few.npy");
predicate near = min l2(z, goal) <= 1;
predicate beside = min linf(r, few) <= 1;
monitor reach = F (near && beside);
END
cat >nested.etl <<'END'
spec nested;
input x : f32;
input y : f32;
predicate a = x > 0;
predicate b = y > 0;
monitor chain = F (a && F (b && F (a && b)));
monitor counted = F[0, 40] (a && (b U[2, 9] a));
monitor waits = G (a -> F[3, 30] b);
monitor past = G (a S[2, 12] b);
sliding monitor soon = a U[1, 8] b;
END
cat >projected.etl <<'END'
spec projected;
input z : f32[33];
input x, y : f32;
projection P = load("map.npy");
projection Q = [[1, 2, 0, 1, 0], [0, 1, 0, 1, 1]] offset [0, 1, 0, 0, 0.5];
projection T = [[1, 2]];
target many = load("many.npy");
target spot = [[0.5, 1]];
predicate near = min l2(P(z), many) <= 1;
predicate there = mean l1(Q(P(z)), many) <= 1;
predicate ahead = l2(T([x, y]), spot) <= 1;
monitor reach = F (near && there && ahead);
END
cat >earlier.etl <<'END'
spec earlier;
input z : f16[5] hold 2;
input w : i8[3] scale 0.25;
input v : f32[2];
input x : f32, stale after 3;
projection P = [[1, 2, 0, 1, 0], [0, 1, 0, 1, 1]] offset [0, 1, 0, 0, 0.5];
target rows = load("short.npy");
target pairs = load("rows.npy");
predicate still = l2(z, z@40) <= 1;
predicate apart = cosine(w@33, w@7) >= 0.5;
predicate along = l1(P(z)@3, P(z@1)) - min l2(v@2, rows) <= 1;
predicate alike = min l2([z, v@31], pairs) <= 2;
predicate steady = max(x, 9 steps) - min(x - x@5, 2 steps) + mean(max(x, 3 steps), 20 steps) <= 1;
monitor seen = F (still && apart && along);
monitor often = G (count(still, 30 steps) < 4 || count(apart || along, 7 steps) >= 2);
monitor steadily = F fraction(still, 30 steps) > 0.9;
sliding monitor soon = F[0, 3] (alike || steady);
END
cp "$source/tests/spec/ok/adaptive.etl" "$source/tests/spec/ok/adaptive.thresholds.json" .

# The figures of "all together": state, targets, and targets without SIMD if these differ.
figures() { sed -n 's|^//   all together *||p' "$1"; }
sizeof() { "$1nm" -S --radix=d "$2" | awk '$4 == "monitor_size" { print $2 + 0 }'; }
targets() {  # only arrays, not functions named after them
    "$1nm" -S -C --radix=d "$2" |
        awk '$3 ~ /[rRdDvVu]/ && /targets::|projections::|kColumns/ { sum += $2 }
             END { print sum + 0 }'
}

checks=0
holds() {  # PREFIX NAME STATE TARGETS FLAG...
    local prefix=$1 name=$2 state=$3 expected=$4
    shift 4
    local compiler=${prefix}g++
    [ -n "$prefix" ] || compiler=$cxx
    "$compiler" "$@" -std=c++17 -ffreestanding -fno-exceptions -fno-rtti \
        -I "$box" -I "$runtime" -c "$name.cpp" -o "$name.o"
    local found
    found=$(sizeof "$prefix" "$name.o")
    [ "$found" = "$state" ] || fail "$compiler $name: sizeof(Monitor) is $found, expected $state"
    found=$(targets "$prefix" "$name.o")
    [ "$found" = "$expected" ] || fail "$compiler $name: targets of $found B, expected $expected"
    checks=$((checks + 1))
}

budget() {  # SPEC OPTION...
    local spec=$1 state vectors scalar operations elements file=0
    shift
    local name=${spec}_$(echo "$*" | tr -dc 'a-z0-9')
    "$etlc" "$spec.etl" "$@" -o "$name.hpp"
    grep -q 'without SIMD' "$name.hpp" && read -r state vectors scalar operations elements \
        <<<"$(figures "$name.hpp")" || read -r state vectors operations elements \
        <<<"$(figures "$name.hpp")"
    [ -n "$elements" ] || fail "$name: no figures"
    scalar=${scalar:-$vectors}
    [ ! -e "$name.targets.bin" ] || file=$(stat -c %s "$name.targets.bin")
    cat >"$name.cpp" <<END
#include "$name.hpp"
char monitor_size[sizeof($spec::Monitor)];
$spec::Verdicts step($spec::Monitor& m, const $spec::Inputs& in);
$spec::Verdicts step($spec::Monitor& m, const $spec::Inputs& in) { return m.step(in); }
END
    echo "$name: state $state, targets $vectors, without SIMD $scalar, in a file $file"
    local word=$state wide=$state
    if [ "$file" != 0 ]; then  # plus a pointer
        word=$((state + 4))
        wide=$(((state + 8 + 7) / 8 * 8))
    fi
    if [ "$(uname -m)" = x86_64 ]; then
        # The kernels once, not for each instruction set: their targets are the same.
        holds "" "$name" "$wide" $((vectors - file)) -O1 -DETLMON_NO_DISPATCH
    fi
    holds arm-none-eabi- "$name" "$word" $((scalar - file)) -Os -mcpu=cortex-m4 -mthumb \
        -mfpu=fpv4-sp-d16 -mfloat-abi=hard
    holds riscv64-unknown-elf- "$name" "$word" $((scalar - file)) -Os --specs=picolibc.specs \
        -march=rv32imafc -mabi=ilp32f
}

for spec in scalars two_distances padded weighted quadratic nested adaptive projected earlier; do
    budget "$spec"
done
for spec in scalars nested padded projected earlier; do
    budget "$spec" --values boolean
done
budget narrow --targets-as f16
budget narrow --targets-as i8
budget searched --inline-targets 1000
budget projected --inline-targets 500
budget adaptive --recorder 3,2,2
budget earlier --inline-targets 500
budget earlier --explain --recorder 3,2,2
for spec in scalars nested adaptive; do
    budget "$spec" --explain
done
budget searched --inline-targets 1000 --explain --recorder 0,1,1
budget scalars --values boolean --recorder 0,0,1
[ "$checks" -ge 48 ] || fail "only $checks objects were looked at"
