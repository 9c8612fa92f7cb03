#!/usr/bin/env bash
# standalone_test.sh ETLC CXX...: a header made with --standalone needs no include path, compiles
# without a warning and freestanding, may stand next to another one in a program, and answers as the
# header that includes the runtime does. The portable one has nothing of any machine in it, and is
# short enough to be read.
set -euo pipefail
etlc=$1
shift
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
runtime=$here/../../runtime/include
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT
cd "$box"

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

# Limits: a distance; none; every distance and storage, machines and windows.
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
"$etlc" reach.etl --standalone -o reach.hpp
"$etlc" reach.etl --standalone=portable -o same.hpp
"$etlc" level.etl --standalone -o level.hpp
cmp reach.hpp same.hpp
for limit in reach.hpp:2700 level.hpp:1200; do
    lines=$(wc -l <"${limit%:*}")
    echo "${limit%:*}: $lines lines"
    if [ "$lines" -ge "${limit#*:}" ]; then
        echo "FAILED: ${limit%:*} has $lines lines, expected less than ${limit#*:}"
        exit 1
    fi
done
for example in "$here"/../../examples/firmware_loop/*.etl; do
    "$etlc" "$example" --standalone -o "pasted/example_$(basename "$example" .etl).hpp"
done
if grep -n '#include "' pasted/*.hpp host/*.hpp reach.hpp level.hpp; then
    echo "FAILED: a standalone header includes a file that its user does not have"
    exit 1
fi
if grep -n -E 'asm|cpuid|__builtin_(ia32|cpu)|vector_size|ETLMON_(GNU|VECTORS|PORTABLE)' \
    pasted/*.hpp reach.hpp level.hpp; then
    echo "FAILED: a portable header has something of one machine in it"
    exit 1
fi
for cxx in "$@"; do
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
