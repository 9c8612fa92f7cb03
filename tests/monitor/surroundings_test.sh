#!/usr/bin/env bash
# surroundings_test.sh ETLC SOURCE CXX...: the headers of one spec with all features, in every form,
# compile after <windows.h>, <Arduino.h>, Qt and X11, whose macros are its names, and leave these
# macros unchanged. A monitor at namespace scope is initialised before any code runs, on the host
# and on the boards, and equals one constructed at run time; after reset() a monitor equals a new
# one.
. "$(dirname "$0")/../box.bash"
etlc=$1 source=$2
shift 2
runtime=$source/runtime/include

cat >all.etl <<'END'
spec small;
input near : f32 in [-2, 2];
input far : f32 hold 1;
input slots : bool;
input B1 : bool hold 2;
input hyper : f32[2] hold 1;
target interface = [[1, 0.5], [0.5, 1]];
target True = [[-1, 0.25]];
projection Opposite = [[1, 1], [1, -1]];
projection Q = [[1, 1], [1, -1]];
predicate pascal = near <= 1;
predicate cdecl = min l2(hyper, interface) <= 0.75;
predicate None = min cosine(hyper, interface) - cosine(hyper, True) <= 0.25;
predicate Below = l1(Opposite(hyper), True) <= 2 missing true;
predicate turned = l1(Q(hyper), True) <= 2;
let emit = cdecl || None || turned;
monitor forever = G B1 && F pascal;
monitor grp1 = G (pascal -> F[2, 5] slots);
monitor B101 = F (emit && F (Below && F slots));
monitor Always = G[1, 5] X (O[0, 2] O None W (pascal U F[1, 3] slots));
monitor rad12 = G[1, 25] (slots -> X (cdecl U[0, 12] (pascal && F[0, 15] !slots)));
monitor Convex = G F[0, 20] (pascal && F[0, 7] cdecl);
repeating monitor foreach = F[0, 9] (far > 1 && held[2] slots);
restartable monitor signals = G (cdecl S[1, 3] pascal);
sliding monitor Status = F[0, 3] (far * far > 1 S[1, 4] min l2([near, far], interface) < 1);
END
cp "$source/tests/spec/ok/adaptive.etl" "$source/tests/spec/ok/adaptive.thresholds.json" .
limits=(--max-state 16777216 --max-code 16777216 --max-work 67108864)
# Each line is compiled as one source: a standalone header has a runtime of its own.
groups=('plain boolean explained recorded narrow retargeted' alone)
header() {  # FORM OPTION...
    "$etlc" all.etl "${limits[@]}" --namespace "$1::small" -o "$1.hpp" "${@:2}" 2>words.txt ||
        { cat words.txt; fail "$1"; }
}
header plain
header boolean --values boolean
header explained --explain --lets
header recorded --recorder 3,2,2
header narrow --targets-as f16 --lets
header retargeted --retargetable
header alone --standalone
header stored --inline-targets 0
"$etlc" adaptive.etl -o adaptive.hpp

# ---- macros, as those headers define them

cat >platform.h <<'END'
#define near
#define far
#define small char
#define hyper __int64
#define interface struct
#define pascal __stdcall
#define cdecl __cdecl
#define grp1 0x0430
#define rad12 0x042b
#define IN
#define OUT
#define CONST const
#define VOID void
#define TRUE 1
#define FALSE 0
#define ERROR 0
#define DELETE (0x00010000L)
#define min(a, b) (((a) < (b)) ? (a) : (b))
#define max(a, b) (((a) > (b)) ? (a) : (b))
#define Yield()
#define abs(x) ((x) > 0 ? (x) : -(x))
#define round(x) ((x) >= 0 ? (long)((x) + 0.5) : (long)((x) - 0.5))
#define bit(b) (1UL << (b))
#define sq(x) ((x) * (x))
#define F(string_literal) (reinterpret_cast<const void*>(string_literal))
#define word(...) makeWord(__VA_ARGS__)
#define B0 0
#define B1 1
#define B101 5
#define HIGH 1
#define LOW 0
#define INPUT 0
#define DEFAULT 1
#define EULER 2.718281828459045
#define I _Complex_I
#define True 1
#define False 0
#define None 0L
#define Bool int
#define Status int
#define Success 0
#define Always 2
#define Above 0
#define Below 1
#define Opposite 4
#define Convex 2
#define Complex 0
#define signals public
#define slots
#define emit
#define foreach(a, b) for (a : b)
#define forever for (;;)
END
letters=()
for letter in {A..Z}; do letters+=("-D$letter=1"); done
for forms in "${groups[@]}"; do
    [ "$forms" = alone ] || forms+=" stored"
    # shellcheck disable=SC2086
    {
        echo '#include "platform.h"'
        printf '#include "%s.hpp"\n' $forms
        cat <<'END'
small initial_of(interface Point);
interface Point { small near letter; };
#if B101 != 5 || Always != 2 || !defined(slots) || !defined(far) || !defined(foreach)
#error "a macro is gone"
#endif
END
    } >use.cpp
    for compiler in "$@"; do
        "$compiler" -std=c++17 -Wall -Wextra -Werror -I "$runtime" -fsyntax-only use.cpp ||
            fail "$compiler: a header among the macros of a platform"
    done

    # A program that has every single capital letter as a macro.
    # shellcheck disable=SC2086
    printf '#include "%s.hpp"\n' $forms >use.cpp
    for compiler in "$@"; do
        "$compiler" "${letters[@]}" -std=c++17 -Wall -Wextra -Werror -I "$runtime" -fsyntax-only \
            use.cpp || fail "$compiler: a header where capital letters are macros"
    done
done

{
    echo '#include "platform.h"'
    (cd "$runtime" && find etlmon -name '*.hpp' -not -path '*/hosted/*') |
        LC_ALL=C sort | sed 's/.*/#include "&"/'
} >runtime.cpp
for compiler in "$@"; do
    "$compiler" "${letters[@]}" -UF -UI -std=c++17 -Wall -Wextra -Werror -I "$runtime" \
        -fsyntax-only runtime.cpp || fail "$compiler: the runtime among the macros of a platform"
done

# ---- at namespace scope

for forms in "${groups[@]}"; do
    [ "$forms" = alone ] || forms+=" adaptive"
    for form in $forms; do
        space=$form
        [ "$form" = adaptive ] || space=$form::small
        echo "#include \"$form.hpp\""
        [ "$form" != retargeted ] || echo "AT_COMPILE_TIME $space::Shadow shadow;"
        echo "AT_COMPILE_TIME $space::Monitor monitor_$form;"
    done >global.cpp
    for compiler in "$@"; do
        "$compiler" -std=c++20 -DAT_COMPILE_TIME=constinit -Wall -Wextra -Werror -I "$runtime" \
            -fsyntax-only global.cpp ||
            fail "$compiler: a monitor is not initialised at compile time"
        "$compiler" -std=c++17 -DAT_COMPILE_TIME= -O0 -I "$runtime" -c global.cpp -o global.o
        if objdump -h global.o | grep -E '\.init_array|\.ctors'; then
            fail "$compiler: a monitor is initialised by code"
        fi
    done
    for prefix in arm-none-eabi- riscv64-unknown-elf-; do
        command -v "${prefix}g++" >where.txt || continue
        flags=(-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard)
        [ $prefix = arm-none-eabi- ] ||
            flags=(--specs=picolibc.specs -march=rv32imafc -mabi=ilp32f)
        "${prefix}g++" "${flags[@]}" -std=c++17 -DAT_COMPILE_TIME= -Os -ffreestanding \
            -fno-exceptions -fno-rtti -I "$runtime" -c global.cpp -o global.o
        if "${prefix}objdump" -h global.o | grep -E '\.init_array|\.ctors'; then
            fail "$prefix: a monitor is initialised by code"
        fi
    done
done

# ---- the same as one made at run time, and as one that was reset

for forms in "${groups[@]}"; do
    cat >same.cpp <<'END'
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

END
    printf '#include "%s.hpp"\n' $forms >>same.cpp
    cat >>same.cpp <<'END'
unsigned state = 1;
float number() {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 20) / 1024.0f - 2.0f;
}
template <class Inputs>
Inputs inputs(float (&z)[2]) {
    Inputs in;
    if (number() > -1.5f) in.near = number();
    if (number() > -1.5f) in.far = number();
    if (number() > -1.5f) in.slots = number() > 0;
    if (number() > -1.5f) in.B1 = number() > -1.9f;
    z[0] = number();
    z[1] = number();
    if (number() > -1.5f) in.hyper = z;
    return in;
}
template <class Monitor, class Inputs>
bool are_same(const char* form, Monitor& global) {
    alignas(Monitor) static unsigned char room[sizeof(Monitor)];
    std::memset(room, 0xa5, sizeof room);
    Monitor& made = *new (room) Monitor;
    if (std::memcmp(&global, &made, Monitor::kStateBytes) != 0) return false;
    for (int episode = 0; episode < 30; ++episode) {
        Monitor fresh;
        float z[2];
        for (int step = 0; step < 60; ++step) {
            const Inputs in = inputs<Inputs>(z);
            const auto expected = named(fresh.step(in));
            const auto found = named(made.step(in));
            if (step % 17 == 16) fresh.restart_signals(), made.restart_signals();
            for (std::size_t m = 0; m < sizeof expected.entries / sizeof *expected.entries; ++m)
                if (std::memcmp(&expected.entries[m].verdict, &found.entries[m].verdict,
                                sizeof expected.entries[m].verdict) != 0)
                    return std::printf("%s %d %d %s\n", form, episode, step,
                                       expected.entries[m].name), false;
        }
        made.reset();
    }
    return true;
}
END
    for form in $forms; do echo "$form::small::Monitor monitor_$form;"; done >>same.cpp
    echo 'int main() {' >>same.cpp
    for form in $forms; do
        cat <<END
    if (!are_same<$form::small::Monitor, $form::small::Inputs>("$form", monitor_$form)) return 1;
END
    done >>same.cpp
    echo '}' >>same.cpp
    "$1" -std=c++17 -O1 -I "$runtime" same.cpp -o same
    ./same || fail "constructed, and reset, monitors differ"
done
