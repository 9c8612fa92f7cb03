#!/usr/bin/env bash
# standalone_test.sh ETLC CXX...: a header made with --standalone needs no include path,
# compiles without a warning and freestanding, may stand beside another one in a program, and
# answers as the header that includes the runtime does.
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
mkdir pasted included
for spec in responses pending; do
    "$etlc" "$here/cases/$spec.etl" --standalone -o "pasted/$spec.hpp"
    "$etlc" "$here/cases/$spec.etl" -o "included/$spec.hpp"
done
if grep -n '#include "' pasted/*.hpp; then
    echo "FAILED: a standalone header includes a file that its user does not have"
    exit 1
fi
for cxx in "$@"; do
    for spec in responses pending; do
        echo "#include \"$spec.hpp\"" >alone.cpp
        "$cxx" "${flags[@]}" -ffreestanding -fno-exceptions -fno-rtti -I pasted -c alone.cpp \
          -o alone.o
    done
    "$cxx" "${flags[@]}" -I pasted main.cpp -o with_pasted
    "$cxx" "${flags[@]}" -I included -I "$runtime" main.cpp -o with_included
    ./with_pasted >pasted.txt
    ./with_included >included.txt
    [ "$(wc -l <pasted.txt)" -eq 2200 ]
    cmp pasted.txt included.txt
done
