#!/usr/bin/env bash
# names_test.sh ETLC CHECK_NAMES CXX...: no name that a spec may declare collides with the generated
# code. Every identifier in the headers of one spec with all features, in both modes, becomes a name
# of that spec: as an input, a flag, an embedding, a target, a predicate, a let, a monitor, a
# sliding monitor and a namespace. The headers compile without a warning, and their verdicts equal
# those of `etlc run`. The last compiler makes the program that prints them.
. "$(dirname "$0")/../box.bash"
etlc=$1
check_names=$2
shift 2
limits=(--max-state 16777216 --max-code 16777216 --max-work 67108864)
flags=(-std=c++17 -O0 -Wall -Wextra -Wshadow -Werror)

cat >base.txt <<'END'
input x : f32 in [-2, 2];
input y : f32 hold 1, stale after 3;
input on : bool;
input beat : bool hold 2;
input z, w : f32[2];
target goal = [[1, 0.5], [0.5, 1]];
target home = [[-1, 0.25]];
predicate low  = x <= calibrated(adaptive, alpha = 0.25, gamma = 0.25, lo = 0.5, hi = 2);
predicate near = min l2(z, goal) <= 0.75;
predicate aim  = min cosine(z, goal) <= 0.25;
predicate back = cosine(z, home) - min cosine(w, goal) > 0.5;
let ready_now = near || aim;
monitor held = G beat && F low;
monitor answered = G (low -> F[2, 5] on);
monitor ordered = F (ready_now && F (back && F on));
monitor again = G[1, 5] X (O[0, 2] O aim W (F low U F[1, 3] on));
monitor flags = G[1, 25] (on -> X (near U[0, 12] (low && F[0, 15] !on)));
sliding monitor soon = F[0, 3] (y * y > 1 S[1, 4] min l2([x, y], goal) < 1);
END
echo "truth low = y < 1;" >>base.txt
{ echo "spec base;"; cat base.txt; } >base.etl
for x in 0.5 0.75 1; do printf 'x,y\n%s,0\n' $x >demonstration_$x.csv; done
"$etlc" calibrate base.etl --data demonstration_*.csv -o thresholds.json >report.txt 2>&1 ||
  { cat report.txt >&2; exit 1; }
header() {
    "$etlc" "$1" --thresholds thresholds.json "${limits[@]}" --recorder 1,1,1 -o "$2" "${@:3}" \
        2>words.txt || { head -20 words.txt >&2; exit 1; }
}

# ---- the identifiers

header base.etl robustness.hpp
header base.etl boolean.hpp --values boolean
header base.etl explained.hpp --explain
header base.etl stored.hpp --values boolean --inline-targets 0
header base.etl narrow.hpp --targets-as i8
header base.etl halves.hpp --targets-as f16
reserved='spec rate period input target predicate truth let monitor sliding
  true false calibrated load inf X F G U W R Y O H S iff implies or and not
  until weak_until release since next eventually always previous once historically'
sed 's|//.*||; /^#/d' robustness.hpp boolean.hpp explained.hpp stored.hpp narrow.hpp \
    halves.hpp |
    grep -oP '(?<![0-9A-Za-z_])[A-Za-z_][A-Za-z_0-9]*' | LC_ALL=C sort -u |
    grep -vxF "$(tr -s ' ' '\n' <<<"$reserved")" >all.txt
declared=$(grep -oE '(input|target|predicate|let|monitor) [a-z_, ]+' base.txt |
  sed 's/^[a-z]* //; s/,//g')
"$check_names" field <all.txt | grep -vxF "$(tr -s ' ' '\n' <<<"$declared")" >names.txt
[ "$(wc -l <names.txt)" -gt 120 ]
printf "%s\n" step finished measured targets verdicts >>names.txt  # identifiers of an older header
LC_ALL=C sort -u names.txt -o names.txt

# ---- each in each role, all at once: a spec, a trace and the feeding code

roles=7
steps=10
for ((turn = 0; turn < roles; ++turn)); do
    awk -v turn="$turn" -v roles=$roles -v steps=$steps '
      function value(t, j, k) { return ((t * 7 + j * 5 + k * 3 + int(t * j / 3)) % 17 - 8) / 4 }
      function half(t, j, k) { return (t * 5 + j * 3 + k * 7) % 3 }
      function column(name) { heads = heads (heads == "" ? "" : ",") name }
      function cell(t, text) { cells[t] = cells[t] (cells[t] == "" ? "" : ",") text }
      function feed(t, text) { feeds[t] = feeds[t] text "\n" }
      function scalar(name, j) {
        column(name)
        for (t = 0; t < steps; ++t) {
          v = value(t, j, 0)
          cell(t, v)
          feed(t, sprintf("in.%s = %.2ff;", name, v))
        }
      }
      function flag(name, j) {
        column(name)
        for (t = 0; t < steps; ++t) {
          v = value(t, j, 1) > 0
          cell(t, v)
          feed(t, sprintf("in.%s = %s;", name, v ? "true" : "false"))
        }
      }
      function vector(name, j, type) {
        column(name "[0]"); column(name "[1]")
        for (t = 0; t < steps; ++t) {
          for (k = 0; k < 2; ++k) {
            v = value(t, j, k) + 0.125
            if (type == "uint16_t") {
              n = half(t, j, k)
              v = n - 1
              bits = n == 0 ? "0xbc00" : n == 1 ? "0" : "0x3c00"
            }
            if (type == "int8_t") v = 4 * value(t, j, k) + 1
            cell(t, v); e[k] = type == "uint16_t" ? bits : type == "float" ? sprintf("%.4ff", v) : v
          }
          feed(t, sprintf("static const %s values_%d_%d[] = {%s, %s};", type, j, t, e[0], e[1]))
          feed(t, sprintf("in.%s = values_%d_%d;", name, j, t))
        }
      }
      BEGIN {
        spec = "spec turn" turn ";\n"
        while ((getline line < "base.txt") > 0) spec = spec line "\n"
        scalar("x", 1000); scalar("y", 1001); flag("on", 1002); flag("beat", 1003)
        vector("z", 1004, "float"); vector("w", 1005, "float")
      }
      {
        j = NR; role = (j + turn) % roles; c = (j + 1) / 512
        if (role == 0) {
          formula = "F (" $1 " * " $1 " > 1) && G (" $1 " <= 1.5)"
          spec = spec "input " $1 " : f32 in [-2, 2];\nmonitor zz" j " = " formula ";\n"
          scalar($1, j)
        } else if (role == 1) {
          spec = spec "input " $1 " : bool" (j % 3 ? "" : " hold 1") ";\n"
          spec = spec "monitor zz" j " = G[0, 2] " $1 " || F (" $1 " && !on);\n"
          flag($1, j)
        } else if (role == 2) {
          of = j % 2 ? "x - " c " >= 0.5" : "min l2(z, goal) <= " (0.5 + c)
          spec = spec "predicate " $1 " = " of ";\nmonitor zz" j " = G (" $1 " -> F[0, 2] on);\n"
        } else if (role == 3) {
          kind = int(j / roles) % 4
          above = "x > " c
          if (kind == 0) formula = "F (" above " && F on)"
          if (kind == 1) formula = "G (" above " -> F[0, 3] near)"
          if (kind == 2) formula = "F " above " && G on"
          if (kind == 3) formula = "G[1, 3] (" above " U[0, 2] on)"
          spec = spec "monitor " $1 " = " formula ";\n"
        } else if (role == 4) {
          formula = j % 16 < 8 ? "F[0, 2] x > " c : "x > " c " S on"
          spec = spec "sliding monitor " $1 " = " formula ";\n"
        } else if (role == 5) {
          formula = "F min l2(z, " $1 ") <= 0.5 && F min cosine(z, " $1 ") <= 0.1"
          spec = spec "target " $1 " = [[" c ", 1], [1, 0.5]];\nmonitor zz" j " = " formula ";\n"
        } else {
          kind = int(j / roles) % 3
          type = kind == 0 ? "f32[2] hold 1" : kind == 1 ? "f16[2]" : "i8[2] scale 0.25"
          spec = spec "input " $1 " : " type ";\n"
          spec = spec "monitor zz" j " = F min l2(" $1 ", goal) <= " (1 + c) ";\n"
          vector($1, j, kind == 0 ? "float" : kind == 1 ? "uint16_t" : "int8_t")
        }
      }
      END {
        printf "%s", spec >"turn" turn ".etl"
        print heads >"turn" turn ".csv"
        for (t = 0; t < steps; ++t) print cells[t] >"turn" turn ".csv"
        inc = "turn" turn ".inc"
        print "template <class Inputs> void feed(Inputs& in, int step) {\nswitch (step) {" >inc
        for (t = 0; t < steps; ++t) printf "case %d: {\n%sbreak;\n}\n", t, feeds[t] >inc
        print "}\n}" >inc
      }' names.txt
done

# ---- headers, expected verdicts, and a program that prints those of the classes

cat >show.hpp <<'END'
#pragma once
#include <cstdio>
#include "etlmon/temporal/boolean_verdict.hpp"
inline const char* word(bool satisfied, bool violated, bool decided) {
    return !decided ? "undecided" : satisfied ? "satisfied" : violated ? "violated" : "unknown";
}
inline void show(const char* mode, int step, const char* name, const etlmon::Verdict& v) {
    std::printf("%s,%d,%s,", mode, step, name);
    if (v.decided())
        std::printf("%.9g,%.9g,%.9g", double(v.lower), double(v.robustness), double(v.upper));
    else
        std::printf(",,");
    std::printf(",%s,%d\n", word(v.satisfied(), v.violated(), v.decided()), int(v.final()));
}
inline void show(const char* mode, int step, const char* name, const etlmon::BooleanVerdict& v) {
    std::printf("%s,%d,%s,,,,%s,%d\n", mode, step, name,
                word(v.satisfied(), v.violated(), v.decided()), int(v.final()));
}
END
# Every header is compiled; verdicts are compared in one mode at a time.
for ((turn = 0; turn < roles; ++turn)); do
    for values in robustness boolean; do
        space=zz_${values}_$turn
        how="--values $values"
        [ $values = boolean ] || ((turn % 4 > 1)) || how=--explain
        header turn$turn.etl $space.hpp $how --namespace $space
        if (((turn + ${#values}) % 2)); then
            printf '#include "%s.hpp"\n' $space >>rest.cpp
            continue
        fi
        "$etlc" run turn$turn.etl --thresholds thresholds.json "${limits[@]}" --values $values \
            --trace turn$turn.csv -o - 2>words.txt | awk -F, -v mode=$space '
              function number(text) {
                return mode ~ /boolean/ ? "" : text ~ /[0-9]/ ? sprintf("%.9g", text + 0) : text
              }
              NR > 1 {
                numbers = number($3) "," number($4) "," number($5)
                print mode "," $1 "," $2 "," numbers "," $6 "," $7
              }
            ' >>expected.csv
        {
            printf '#include "show.hpp"\n#include "%s.hpp"\n' $space
            printf 'namespace run_%s {\n#include "turn%d.inc"\n' $space "$turn"
            printf 'inline void run() {\n%s::Monitor m;\nfor (int t = 0; t < %d; ++t) {\n' $space \
              $steps
            printf '%s::Inputs in;\nfeed(in, t);\nconst %s::Verdicts v = m.step(in);\n' $space \
              $space
            grep -oE 'monitor [A-Za-z_0-9]+ =' turn$turn.etl | awk -v mode=$space \
                '{ printf "show(\"%s\", t, \"%s\", v.%s);\n", mode, $2, $2 }'
            printf '}\n}\n}\n'
        } >>main.cpp
        echo "run_$space::run();" >>calls.txt
    done
done
{ echo 'int main() {'; cat calls.txt; echo '}'; } >>main.cpp
for cxx in "$@"; do "$cxx" "${flags[@]}" -fsyntax-only -I. -I "$runtime" rest.cpp; done
for cxx in "${@:1:$#-1}"; do "$cxx" "${flags[@]}" -fsyntax-only -I. -I "$runtime" main.cpp; done
"${@: -1}" "${flags[@]}" -I. -I "$runtime" main.cpp -o main
./main | LC_ALL=C sort >found.txt
LC_ALL=C sort expected.csv | diff - found.txt >difference.txt || {
    echo "FAILED: other verdicts than those of etlc run:"
    head -20 difference.txt
    exit 1
}
[ "$(wc -l <found.txt)" -gt 5000 ]

# ---- as namespaces

cat >small.etl <<'END'
spec small;
input x : f32;
input on : bool;
input z : f32[2];
target goal = [[1, 0.5]];
predicate near = min l2(z, goal) <= 0.75;
monitor held = G (on -> F[0, 2] near) || F x > 1;
sliding monitor soon = F[0, 3] near S on;
END
"$check_names" namespace <all.txt | while read -r name; do
    for values in robustness boolean; do
        "$etlc" small.etl --values $values --namespace "$name" -o "small_${values}_$name.hpp"
        echo "#include \"small_${values}_$name.hpp\"" >>spaces_$values.cpp
    done
done
"$1" "${flags[@]}" -fsyntax-only -I. -I "$runtime" spaces_boolean.cpp
"${@: -1}" "${flags[@]}" -fsyntax-only -I. -I "$runtime" spaces_robustness.cpp

for name in class linux printf a::class std etlmon::x a::std NULL _a a_ a__b a:: ::a a::::b 1a; do
    status=0
    "$etlc" small.etl --namespace "$name" -o refused.hpp 2>words.txt || status=$?
    [ $status = 2 ] && [ ! -e refused.hpp ] ||
      { echo "FAILED: --namespace $name is not refused"; exit 1; }
done
"$etlc" small.etl --namespace acme::printf -o nested.hpp  # not at global scope

# ---- as lets, which the code does not mention

awk '{ print "zz" NR }' names.txt >others.txt
for values in robustness boolean; do
    for lets in names.txt others.txt; do
        { sed 's/spec base/spec lets/' base.etl
          awk '{ print "let " $1 " = x > " NR / 512 " S on;"
                 print "monitor zy" NR " = F[1, 4] " $1 ";" }' $lets
        } >lets.etl
        header lets.etl lets.hpp --values $values
        # Longer names change the line breaks of comments, and there are two specs.
        sed 's| *//.*||; /kSpecHash/d; /namespace text_/d; /^ *$/d' lets.hpp >>lets_$values.txt
    done
    awk '{ lines[NR] = $0 }
         END { for (n = 1; n <= NR / 2; ++n) if (lines[n] != lines[n + NR / 2]) exit 1 }' \
        lets_$values.txt || { echo "FAILED: the names of lets change the code"; exit 1; }
done
