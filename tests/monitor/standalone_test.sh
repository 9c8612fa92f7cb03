#!/usr/bin/env bash
# standalone_test.sh ETLC CXX...: a header made with --standalone needs no include path, compiles
# without a warning and freestanding, may be combined with another one in a program, and gives the
# verdicts of the header that includes the runtime. The portable one contains nothing
# machine-specific, and is short enough to read.
. "$(dirname "$0")/../box.bash"
etlc=$1
shift

cat >main.cpp <<'END'
#include <cstdio>

#include "pending.hpp"
#include "responses.hpp"

template <class Verdict>
void show(const Verdict& v) {
    std::printf("%.9g %.9g %.9g %u\n", double(v.lower), double(v.robustness), double(v.upper),
                unsigned(v.status));
}

int main() {
    responses::Monitor first;
    pending::Monitor second;
    unsigned state = 1;
    const auto next = [&] {
        return float(int((state = state * 1664525u + 1013904223u) >> 27) - 16) / 4;
    };
    for (int step = 0; step < 200; ++step) {
        responses::Inputs a;
        a.x = next();
        a.y = step % 7 == 0 ? etlmon::kMissing : next();
        const responses::Verdicts v = first.step(a);
        show(v.answered), show(v.later), show(v.within), show(v.held), show(v.until_answered),
            show(v.looks_back);
        pending::Inputs b;
        b.x = a.x, b.y = a.y, b.on = step % 3 == 0;
        const pending::Verdicts w = second.step(b);
        show(w.excused), show(w.until_all), show(w.answered_twice), show(w.kept_after),
            show(w.flags);
    }
}
END
flags=(-std=c++17 -O1 -Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Wpedantic -Werror)
mkdir pasted host included
for spec in responses pending; do
    "$etlc" "$here/cases/$spec.etl" --standalone -o "pasted/$spec.hpp"
    "$etlc" "$here/cases/$spec.etl" --standalone=host -o "host/$spec.hpp"
    "$etlc" "$here/cases/$spec.etl" -o "included/$spec.hpp"
done

# Limits on lines: with a distance; without; with windows, arithmetic and missing samples; and with
# all features, where only the runtime counts, since the class depends on the spec.
cat >reach.etl <<'END'
spec reach;
input z : f32[3];
target goal = [[1, 0, 0], [0, 1, 0]];
predicate near = min l2(z, goal) <= 0.5;
monitor arrives = F near;
END
cat >level.etl <<'END'
spec level;
input x : f32 in [0, 9];
predicate low = x <= 3;
monitor stays = G low;
END
cat >windows.etl <<'END'
spec windows;
input x : f32 in [0, 9];
input y : f32 hold 1;
input on : bool;
predicate small = sqrt(x) + abs(y) / 3 <= 2;
predicate large = x * y - 1 > 0.5;
monitor held = G on && F small;
monitor answered = G (small -> F[2, 5] on);
sliding monitor soon = F[0, 3] (small S[1, 4] large);
sliding monitor late = G[0, 30] (small U[0, 4] large) && O[2, 9] on;
END
cat >everything.etl <<'END'
spec everything;
input z : f32[4] hold 2;
input h : f16[3];
input i : i8[3] scale 0.25;
input x : f32 in [0, 9];
input on : bool;
target a = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]];
target b = [[1, 2, 3], [3, 2, 1]];
predicate near = min l2(z, a) <= 0.5;
predicate square = max l2sq(z, a) <= 0.5;
predicate sum = mean l1(h, b) <= 0.5;
predicate greatest = kth(2) linf(i, b) <= 0.5;
predicate along = min cosine(z, a) <= 0.5;
predicate angle = min angular(i, b) <= 0.5;
predicate weighed = min mahalanobis([1, 2, 3])(h, b) <= 0.5;
predicate turned = min mahalanobis([[2, 0.5, 0], [0.5, 1, 0], [0, 0, 3]])(i, b) <= 0.5;
predicate root = sqrt(x) + abs(x) / 3 <= 2;
monitor held = G on && F near;
monitor answered = G (square -> F[2, 5] on);
monitor ordered = F (sum && F (greatest && F on));
monitor again = G[1, 5] X (O[0, 2] O along W (F angle U F[1, 3] on));
monitor waits = G[1, 25] (on -> X (weighed U[0, 12] (turned && F[0, 15] !on)));
sliding monitor soon = F[0, 3] (root S[1, 4] near);
sliding monitor late = G[0, 30] (root U[0, 4] near);
END
"$etlc" reach.etl --standalone=portable -o same.hpp
# short NAME LIMIT OPTION...: pasted/NAME.hpp has fewer lines; with all features, its runtime.
short() {
    local name=$1 limit=$2 lines
    shift 2
    "$etlc" "$name.etl" --standalone -o "pasted/$name.hpp" "$@"
    lines=$(wc -l <"pasted/$name.hpp")
    if [ "$name" = everything ]; then
        "$etlc" "$name.etl" -o class.hpp "$@"
        lines=$((lines - $(wc -l <class.hpp)))
    fi
    echo "$name $*: $lines lines"
    if [ "$lines" -ge "$limit" ]; then
        echo "FAILED: $name $* has $lines lines, expected less than $limit"
        exit 1
    fi
}
# Boolean monitors also need the algebra of values on demand.
while read -r values more; do
    short reach 2450 --values "$values"
    short level 950 --values "$values"
    short windows $((1350 + more)) --values "$values"
    short everything $((2950 + more)) --values "$values"
    for storage in f16 i8; do
        short everything $((3100 + more)) --values "$values" --targets-as $storage
    done
done <<'END'
robustness 0
boolean 240
END
short reach 2450
cmp pasted/reach.hpp same.hpp
for example in "$here"/../../examples/firmware_loop/*.etl; do
    "$etlc" "$example" --standalone -o "pasted/example_$(basename "$example" .etl).hpp"
done
if grep -n '#include "' pasted/*.hpp host/*.hpp; then
    echo "FAILED: a standalone header includes a file that its user does not have"
    exit 1
fi
if grep -n -E 'asm|cpuid|__builtin_(ia32|cpu)|vector_size|ETLMON_(GNU|VECTORS|PORTABLE)' \
    pasted/*.hpp; then
    echo "FAILED: a portable header has something of one machine in it"
    exit 1
fi
for cxx in "$@"; do
    for spec in windows everything; do
        echo "#include \"$spec.hpp\"" >alone.cpp
        "$cxx" "${flags[@]}" -ffreestanding -fno-exceptions -fno-rtti -I pasted -fsyntax-only \
            alone.cpp
    done
    for spec in responses pending; do
        echo "#include \"$spec.hpp\"" >alone.cpp
        for folder in pasted host; do
            "$cxx" "${flags[@]}" -ffreestanding -fno-exceptions -fno-rtti -I $folder -c alone.cpp \
                -o alone.o
        done
    done
    "$cxx" "${flags[@]}" -I pasted main.cpp -o with_pasted
    "$cxx" "${flags[@]}" -I included -I "$runtime" main.cpp -o with_included
    ./with_pasted >pasted.txt
    ./with_included >included.txt
    [ "$(wc -l <pasted.txt)" -eq 2200 ]
    cmp pasted.txt included.txt
    "$cxx" "${flags[@]}" -I host main.cpp -o with_host
    ./with_host | cmp - included.txt
done
