#!/usr/bin/env bash
# flags_test.sh ETLC GXX CLANGXX: headers and the runtime under many flags. Each set of flags
# compiles. Objects of two sets share no inline function of ours, unless the flags leave all code
# the same to the byte. A unit gives the same bits alone and linked with another, in either order,
# even if that one is compiled for a CPU that this machine does not have. Classes of one name, from
# one spec with other data or options, share nothing either, linked or loaded.
. "$(dirname "$0")/../box.bash"
etlc=$1 gxx=$2 clangxx=$3

# Every family of kernels: rows in lanes and in columns, int8 rows within bounds, float32 for
# undecided comparisons; and every kind of state: a window, a machine, a past operator.
awk 'BEGIN {
  srand(3)
  print "spec flags;\ninput z : f32[70];\ninput y : f16[5];\ninput x : f32 in [0, 9];"
  print "input on : bool;"
  printf "target a = ["
  rows(9, 70)
  printf "];\ntarget b = ["
  rows(6, 5)
  print "];"
  print "predicate near = mean angular(z, a) <= 1.57;\npredicate far = kth(3) l1(y, b) >= 2.5;"
  print "predicate bent = max mahalanobis([2, 1, 1, 0.5, 3])(y, b) < 2.2;"
  print "predicate root = sqrt(x) + x / 3 <= 3.3;"
  print "monitor safe = G (near -> F[0, 3] (bent || root));"
  print "monitor late = F (far && G[0, 2] bent) || on U root;"
  print "sliding monitor held = G[0, 4] (root S near) && O[1, 3] far;"
}
function rows(K, D) {
  for (k = 0; k < K; ++k) {
    printf "%s[", k ? ", " : ""
    for (i = 0; i < D; ++i) printf "%s%.4f", i ? ", " : "", 2 * rand() - 1
    printf "]"
  }
}' >flags.etl
"$etlc" flags.etl --targets-as i8 -o flags.hpp
grep -q measure_scaled flags.hpp || fail "no int8"

cat >unit.cpp <<'END'
#include <initializer_list>

#include "flags.hpp"

extern "C" unsigned ANSWERS(unsigned* to);
unsigned ANSWERS(unsigned* to) {
    flags::Monitor monitor;
    unsigned state = 5, n = 0;
    for (int step = 0; step < 25; ++step) {
        float z[70];
        uint16_t y[5];
        for (float& element : z)
            element =
                static_cast<float>(
                    static_cast<int>((state = state * 1664525u + 1013904223u) >> 16) - 32768) /
                30000.0f;
        for (uint16_t& element : y)
            element =
                static_cast<uint16_t>(0x3800u + ((state = state * 1664525u + 1013904223u) >> 22));
        flags::Inputs in;
        if (step % 7 != 6) in.z = z;
        in.y = y;
        in.x = static_cast<float>((state >> 8) % 90u) / 10.0f;
        in.on = step % 3 == 0;
        const auto verdicts = monitor.step(in);
        for (const etlmon::Verdict& v : {verdicts.safe, verdicts.late, verdicts.held}) {
            to[n++] = etlmon::bits_of(v.lower), to[n++] = etlmon::bits_of(v.robustness);
            to[n++] = etlmon::bits_of(v.upper), to[n++] = v.status;
        }
    }
    return n;
}
END
cat >main.cpp <<'END'
#include <cstdio>
extern "C" unsigned ANSWERS(unsigned* to);
int main() {
  static unsigned bits[1000];
  const unsigned n = ANSWERS(bits);
  for (unsigned i = 0; i < n; ++i) std::printf("%08x%c", bits[i], i % 12 == 11 ? '\n' : ' ');
}
END

# name, compiler, flags. The flags of as_NAME leave the code of NAME unchanged. Functions that must
# be inlined are inlined without optimisation too.
sets() {
  cat <<'END'
base g++ -O2
as_base g++ -O2 -std=gnu++17 -Wall
tiny g++ -Os
debug g++ -O0
fast g++ -O2 -ffast-math
finite g++ -O0 -ffinite-math-only
tiny_fast g++ -Os -ffast-math
plain g++ -O0 -DETLMON_NO_DISPATCH
scalar g++ -O0 -DETLMON_PORTABLE
v2 g++ -O0 -march=x86-64-v2
v3 g++ -O0 -march=x86-64-v3
v4 g++ -O1 -march=x86-64-v4
as_v4 g++ -O1 -march=skylake-avx512 -mtune=generic
avx2 g++ -O0 -mavx2
fma g++ -O0 -mfma
avx2_fma g++ -O0 -mavx2 -mfma
v3_no_fma g++ -O0 -march=x86-64-v3 -mno-fma
v3_no_f16c g++ -O0 -march=x86-64-v3 -mno-f16c
avx512 g++ -O0 -mavx512f -mavx512vl -mavx512bw -mavx512dq
avx512f g++ -O0 -mavx512f
v4_no_fma g++ -O0 -march=skylake-avx512 -mno-fma
v4_no_f16c g++ -O0 -march=skylake-avx512 -mno-f16c
v4_no_vl g++ -O0 -march=skylake-avx512 -mno-avx512vl
vnni g++ -O0 -march=x86-64-v4 -mavx512vnni
clang clang++ -O2
clang_debug clang++ -O0
clang_tiny clang++ -Os
clang_fast clang++ -O2 -ffast-math
clang_v3 clang++ -O0 -march=x86-64-v3
clang_v4 clang++ -O0 -march=skylake-avx512
clang_v4_no_fma clang++ -O0 -march=skylake-avx512 -mno-fma
clang_avx512 clang++ -O0 -mavx512f -mavx512vl -mavx512bw -mavx512dq
END
}

while read -r name cxx flags; do
  [ "$cxx" = g++ ] && cxx=$gxx || cxx=$clangxx
  # shellcheck disable=SC2086
  "$cxx" -std=c++17 $flags -DANSWERS="answers_$name" -I "$runtime" -I . -c unit.cpp \
    -o "$name.o" 2>errors ||
    fail "$name: $cxx $flags does not compile: $(head -n 3 errors)"
done < <(sets)

# Functions of which the linker keeps one copy per name.
for object in *.o; do
  nm --defined-only "$object" |
    awk -v object="${object%.o}" '$2 ~ /^[WwVuv]$/ && $3 ~ /etlmon|flags/ { print $3, object }'
done | sort >weak.txt
[ "$(wc -l <weak.txt)" -gt 100 ] || fail "no inline function is to be seen in the objects"
awk '$2 !~ /^as_/ {
  if ($1 == last) { print $1 " of " before " and of " $2; bad = 1 }
  last = $1; before = $2
} END { exit bad }' weak.txt >shared.txt ||
  fail "one name for the code of different flags: $(head -n 2 shared.txt | c++filt)"
code() {
  objdump -d --no-show-raw-insn "$1.o" |
    sed "1,6d; s/answers_$1/answers/g; s/^.*Disassembly.*answers.*//"
}
for same in as_*.o; do
  same=${same%.o}
  cmp <(code "$same") <(code "${same#as_}") ||
    fail "$same and ${same#as_} have the names of one another, and other code"
done

# The short name of a standalone header differs where vector instructions or -ffast-math do.
mkdir standalone
cp unit.cpp standalone
"$etlc" flags.etl --standalone -o standalone/flags.hpp
while read -r name flags; do
  # shellcheck disable=SC2086
  "$gxx" -std=c++17 $flags -DANSWERS="answers_$name" -c standalone/unit.cpp \
    -o "standalone/$name.o" || fail "standalone $name does not compile"
  nm --defined-only "standalone/$name.o" |
    awk '$2 ~ /^[WwVuv]$/ && $3 ~ /etlmon|flags/ { print $3 }'
done >standalone.txt <<'END'
base -O0
fast -O0 -ffast-math
avx -O0 -mavx
avx2 -O0 -mavx2
fma -O0 -march=x86-64-v3
avx512 -O0 -march=x86-64-v4
END
[ "$(wc -l <standalone.txt)" -gt 300 ] || fail "no inline function in standalone objects"
shared=$(sort standalone.txt | uniq -d | head -n 1)
[ -z "$shared" ] || fail "standalone: one name under different flags: $(c++filt "$shared")"
grep -qE "N6etlmon6v[0-9]_[0-9]_[0-9]" standalone.txt || fail "the short name is longer than v0_3_0"

# Links units together. Units that this machine cannot run are linked only.
run_with() {  # UNIT OBJECT...: the output of the unit in a program of these objects
  local unit=$1
  shift
  "$gxx" "main_$unit.o" "$@" -o program
  ./program
}
ran=0
for unit in base tiny fast clang; do
  "$gxx" -O0 -DANSWERS="answers_$unit" -c main.cpp -o "main_$unit.o"
  run_with "$unit" "$unit.o" >"$unit.alone" 2>/dev/null || continue
  [ "$(wc -l <"$unit.alone")" -eq 25 ] || fail "$unit does not answer"
  for other in base tiny_fast v4 clang_v4; do
    [ "$other" != "$unit" ] || continue
    cmp "$unit.alone" <(run_with "$unit" "$unit.o" "$other.o") ||
      fail "$unit answers otherwise before $other"
    cmp "$unit.alone" <(run_with "$unit" "$other.o" "$unit.o") ||
      fail "$unit answers otherwise after $other"
    ran=$((ran + 1))
  done
done
[ "$ran" -eq 15 ] || fail "only $ran pairs could be run"

# ---- Classes of one name in one program: a spec with other data, thresholds, comments and options.
cat >grasp.etl <<'END'
spec grasp;
const limit = 1;
input z : f32[3];
input q : bool;
target held = [[0, 0, 0]];
predicate near = min l2(z, held) <= limit;
let ready = near && q;
monitor ok = F near;
repeating monitor again = G (q -> F[0, 3] ready);
sliding monitor soon = F[0, 3] near;
END
sed 's/0, 0, 0/5, 5, 5/' grasp.etl >right.etl
sed 's/ok = F/ok = G/' grasp.etl >formula.etl
sed '1s/$/  \/\/ a comment/' grasp.etl >comment.etl
variants=0
while read -r name spec options; do
  mkdir "arm_$name"
  cp "$spec.etl" "arm_$name/grasp.etl"
  # shellcheck disable=SC2086
  (cd "arm_$name" && "$etlc" grasp.etl $options -o grasp.hpp) || fail "arm_$name"
  echo '#include "grasp.hpp"
    grasp::Verdicts STEP(grasp::Monitor& monitor, const grasp::Inputs& in);
    grasp::Verdicts STEP(grasp::Monitor& monitor, const grasp::Inputs& in) {
      monitor.reset();
      return monitor.step(in);
    }' >"arm_$name/unit.cpp"
  "$gxx" -std=c++17 -O0 -DSTEP="step_$name" -I "arm_$name" -I "$runtime" \
    -c "arm_$name/unit.cpp" -o arm.o || fail "arm_$name does not compile"
  nm --defined-only arm.o | awk '$2 ~ /^[WwVuv]$/ && $3 ~ /5grasp/ { print $3 }' >arm.txt
  [ "$(wc -l <arm.txt)" -gt 5 ] || fail "arm_$name: no inline function is to be seen"
  cat arm.txt >>arms.txt
  variants=$((variants + 1))
done <<'END'
left grasp
right right
formula formula
comment comment
limit grasp --set limit=2
lets grasp --lets
explain grasp --explain
recorder grasp --recorder 4,2,2
boolean grasp --values boolean
narrow grasp --targets-as i8
stored grasp --inline-targets 0
moving grasp --retargetable
alone grasp --standalone
alone_right right --standalone
host grasp --standalone=host
END
[ "$variants" -eq 15 ] || fail "only $variants variants"
shared=$(sort arms.txt | uniq -d | head -n 1)
[ -z "$shared" ] || fail "two classes share $(c++filt "$shared")"

cat >arm.cpp <<'END'
#include "grasp.hpp"
extern "C" bool ARM(const float (&z)[3]);
bool ARM(const float (&z)[3]) {
  grasp::Monitor monitor;
  grasp::Inputs in;
  in.z = z;
  return monitor.step(in).ok.satisfied();
}
END
cat >arms.cpp <<'END'
#include <dlfcn.h>

#include <cstdio>
#ifdef LOADED
using Arm = bool (*)(const float (&z)[3]);
static Arm arm_of(const char* file, const char* name) {
  void* library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  return library == nullptr ? nullptr : reinterpret_cast<Arm>(dlsym(library, name));
}
static const Arm left_arm = arm_of("./left.so", "left_arm");
static const Arm right_arm = arm_of("./right.so", "right_arm");
#else
extern "C" bool left_arm(const float (&z)[3]);
extern "C" bool right_arm(const float (&z)[3]);
#endif
int main() {
  const float at_left[3] = {0, 0, 0}, at_right[3] = {5, 5, 5};
  std::printf("%d%d%d%d\n", left_arm(at_left), left_arm(at_right), right_arm(at_left),
              right_arm(at_right));
}
END
for cxx in "$gxx" "$clangxx"; do
  for flags in "-O0 -g" "-O2 -DNDEBUG"; do
    # shellcheck disable=SC2086
    for side in left right; do
      "$cxx" -std=c++17 $flags -fPIC -DARM=${side}_arm -I "arm_$side" -I "$runtime" -c arm.cpp \
        -o $side.o
      "$cxx" -shared $side.o -o $side.so
    done
    "$cxx" arms.cpp left.o right.o -o linked
    "$cxx" -DLOADED arms.cpp -ldl -o loaded
    for program in linked loaded; do
      said=$(./$program)
      [ "$said" = 1001 ] || fail "$cxx $flags: two arms, $program: $said"
    done
  done
done
printf '#include "%s/grasp.hpp"\n' arm_left arm_right >both.cpp
echo 'grasp::Monitor monitor;' >>both.cpp
for cxx in "$gxx" "$clangxx"; do
  ! "$cxx" -std=c++17 -I "$runtime" -fsyntax-only both.cpp 2>said ||
    fail "$cxx takes either of two classes of one name"
  grep -q ambiguous said || fail "$cxx on two classes of one name: $(head -n 3 said)"
done
