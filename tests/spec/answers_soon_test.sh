#!/usr/bin/env bash
# answers_soon_test.sh ETLC SECONDS KILOBYTES: etlc compiles or refuses specs of 10 KB within
# SECONDS of processor time and KILOBYTES of memory (0: any), with output of reasonable length. Each
# spec below would take hours or all memory in a compiler that walks formulas as trees, or that
# builds state machines of any size. etlc explains their verdicts as quickly, on a trace where any
# of thousands of samples may flip them.
set -euo pipefail
etlc=$1
seconds=$2
kilobytes=$3
most_diagnostics=400000 # bytes; 200 of them are shown
most_message=1000       # characters per line
most_header=1000000
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT
cd "$box"

fail() {
  echo "answers_soon_test: $*" >&2
  exit 1
}

# times N TEXT: the TEXT N times, with i replaced by 0, 1, ... and j by i + 1
times() {
  awk -v n="$1" -v text="$2" 'BEGIN {
    for (i = 0; i < n; ++i) {
      t = text
      gsub(/@i/, i, t); gsub(/@j/, i + 1, t); gsub(/@m/, i % 3, t)
      printf "%s", t
    }
  }'
}

# answers STATUS NAME: compiles the declarations on standard input, with this exit status
answers() {
  local status=0
  {
    echo "spec s; input x : f32 in [-1, 1]; input y : f32; input b : bool;"
    echo "predicate p0 = x > 0; predicate p1 = y > 0; predicate p2 = y < 0.5;"
    cat
  } >"$2.etl"
  [ "$(stat -c %s "$2.etl")" -le 10000 ] || fail "$2 is larger than 10 KB"
  (
    ulimit -t "$seconds"
    [ "$kilobytes" = 0 ] || ulimit -v "$kilobytes"
    exec "$etlc" "$2.etl" -o "$2.hpp" >"$2.out" 2>"$2.err"
  ) || status=$?
  [ "$status" = "$1" ] || fail "$2: exit status $status, expected $1: $(head -c 500 "$2.err")"
  [ "$(stat -c %s "$2.err")" -le $most_diagnostics ] ||
    fail "$2: $(stat -c %s "$2.err") bytes of diagnostics"
  [ "$(wc -L <"$2.err")" -le $most_message ] || fail "$2: a line of $(wc -L <"$2.err") characters"
  [ "$status" != 0 ] || [ "$(stat -c %s "$2.hpp")" -le $most_header ] ||
    fail "$2: $(stat -c %s "$2.hpp") bytes"
}

# ---- shared parts: the text of the whole doubles with each let

{ echo "let a0 = x > 0;"; times 22 "let a@j = a@i S !a@i;"; echo "sliding monitor m = a22;"; } |
  answers 0 since
{ echo "let a0 = x > 0;"; times 400 "let a@j = a@i S !a@i;"; echo "monitor m = G a400;"; } |
  answers 0 long_since
{ echo "let a0 = x > 0;"; times 60 "let a@j = a@i U[0, 2] !a@i;"; echo \
  "sliding monitor m = a60;"; } | answers 0 until
{ echo "let a0 = x > 0;"; times 300 "let a@j = a@i W !a@i;"; echo "monitor m = a300;"; } |
  answers 1 weak
{ echo "monitor m = "; times 100 "x > @i <-> "; echo "b;"; } | answers 0 iff
{ echo "monitor m = G ("; times 60 "(F x > @i) <-> "; echo "b);"; } | answers 1 iff_of_futures
{ echo "let a0 = b; let c0 = p0;"
  times 100 "let a@j = (a@i || O c@i) && (p@m || c@i); let c@j = (c@i && a@i) || Y a@i;"
  echo "monitor m = G a100;"; } | answers 0 mixed
{ echo "let a0 = b S p0;"; times 300 "let a@j = a@i S !a@i;"; echo \
  "monitor m = F (a300 -> a299);"; } | answers 0 warned
{ echo "let a0 = b && p0;"; times 200 "let a@j = a@i && (a@i || b);"; echo \
  "monitor m = F a200;"; } | answers 0 conjuncts

# ---- refusals: as quick and as short

for depth in 20 24 200; do
  { echo "let c0 = x > 0;"; times $depth "let c@j = F c@i && !(G c@i);"; echo \
    "monitor m = c$depth;"; } |
    answers 1 nested_$depth
done
echo "monitor m = G F[100,1000] (p0 U p1);" | answers 0 windows
echo "monitor m = G F[1000,100000] (p0 U p1);" | answers 1 long_windows
echo "monitor m = F G[1073741823,2147483646] ((F p0) U (G p1));" | answers 1 longest_windows
{ echo "monitor m = "; times 40 "F G "; echo "p0;"; } | answers 1 alternating
{ echo "monitor m = "; times 100 "(p@m R "; echo "p1"; times 100 ")"; echo ";"; } |
  answers 0 releases
{ echo "monitor m = "; times 24 "F (p@m && !(G "; echo "p1"; times 24 "))"; echo ";"; } |
  answers 1 alternatives
{ times 150 "monitor m@i = G F[@i, @j00] (p0 U p1);"; } | answers 1 many

# ---- wide, long and broken ones

{ echo "monitor m = "; times 350 "F[0, @i] (x > @i) && "; echo "b;"; } | answers 1 wide
times 120 "monitor m@i = F[0, @i] p@m; sliding monitor s@i = H[0, @i] b;" | answers 0 monitors
{ echo "monitor m = "; times 120 "((x > 0) + ((b && ("; } | answers 1 broken
times 850 "let a = b; " | answers 1 repeated
# ---- explanations: after 2000 steps

awk 'BEGIN {
  print "x,y,b"
  for (i = 0; i < 2000; ++i)
    printf "%.3f,%.3f,%d\n", i * 37 % 97 / 97, i * 53 % 89 / 89, i * 7 % 3 % 2
}' >trace.csv

# explained NAME: explains the verdict of the monitor on standard input
explained() {
  { echo "spec s; input x, y : f32; input b : bool;"; cat; } >"$1.etl"
  (
    ulimit -t "$seconds"
    exec "$etlc" explain "$1.etl" --trace trace.csv --step 1999 >"$1.why" 2>"$1.err"
  ) || fail "$1: $(head -c 500 "$1.err")"
  grep -q "^smallest change" "$1.why" || fail "$1: $(cat "$1.why")"
}

{ echo "monitor m = G ("; times 20 "x > 0.5 <-> y > 0.5 <-> "; echo "true);"; } | explained iffs
{ echo "monitor m = G ("; times 20 "b <-> y == 0 <-> b <-> y == 0 <-> "; echo "true);"; } |
  explained iffs_of_bools
{ echo "monitor m = G ("; times 20 "x > 0.5 -> y > 0.5 -> "; echo "true);"; } |
  explained implications
{ echo "let a0 = x > 0.5;"; times 12 "let a@j = y > 0.5 <-> O[0, @j] (x > 0.3 <-> a@i);"; echo \
  "monitor m = G (a12 || !a12);"; } | explained iffs_of_pasts
{ echo "monitor m = G ("; times 40 "(x <= 1) S ("; echo "x <= 1"; times 40 ")"; echo ");"; } |
  explained sinces
{ echo "monitor m = F[0, 5] ("; times 40 "x > 0.5 U[0, 3] ("; echo "y > 0.5"; times 40 ")"; echo \
  ");"; } | explained untils
{ echo "monitor m = G ("; times 40 "y <= 1 && X ("; echo "x > -1"; times 40 ")"; echo ");"; } |
  explained nexts
echo "answers_soon_test: ok"
