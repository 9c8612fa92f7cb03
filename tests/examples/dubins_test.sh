#!/usr/bin/env bash
# dubins_test.sh PROGRAM ETLC SPEC: the demo runs twice with the same output and agrees with the
# truth on most drives; for the recorded drives `etlc run` and `etlc evaluate` agree with the
# compiled monitor, and `etlc report` makes a page with the camera's pictures.
. "$(dirname "$0")/../box.bash"
program=$1 etlc=$2 spec=$3

"$program" one >one.txt
"$program" two >two.txt
diff <(sed 's#in one#in FOLDER#' one.txt) <(sed 's#in two#in FOLDER#' two.txt)
diff -r one two
rm -r two

[ "$(grep -cE '^ +[0-9]+  [A-Z]' one.txt)" = 100 ] ||
    { echo "not a line for each of 100 drives"; exit 1; }
for monitor in reach avoid reach_avoid sequential; do
    agreeing=$(sed -nE "s/^$monitor +([0-9]+) of 100 .*/\1/p" one.txt)
    [ "${agreeing:-0}" -ge 90 ] ||
        { echo "$monitor agrees with the truth in ${agreeing:-no} drives of 100"; exit 1; }
done
if grep -q $'\e' one.txt; then echo "colour in a file"; exit 1; fi

# The figures of the compiled class equal those of `etlc evaluate`.
"$etlc" evaluate "$spec" --data one --json figures.json >/dev/null
for predicate in at_a at_b near_c; do
    compiled=$(sed -nE "s/^$predicate +[0-9]+ of 24000 +([0-9.]+) .*/\1/p" one.txt)
    evaluated=$(python3 -c 'import json, sys
print("%.3f" % json.load(open("figures.json"))["predicates"][sys.argv[1]]["f1"])' "$predicate")
    [ "$compiled" = "$evaluated" ] ||
        { echo "F1 of $predicate: compiled $compiled, evaluated $evaluated"; exit 1; }
done

"$etlc" report "$spec" --data one --frames camera -o page.html 2>err.txt
if grep -q warning err.txt; then cat err.txt; exit 1; fi
[ "$(grep -o 'data:image/png' page.html | wc -l)" = 100 ] ||
    { echo "not a sheet of pictures for each of 100 drives"; exit 1; }

# The last verdict of each monitor on a recorded drive, from the plan and from the compiled code.
"$etlc" run "$spec" --trace one/009.npz -o verdicts.csv
run=$(awk -F, '
    NR > 1 { last[$2] = $6 }
    END { print last["reach"], last["avoid"], last["reach_avoid"], last["sequential"] }
' verdicts.csv)
line=$(grep -E '^ +9  ' one.txt)
compiled=$(grep -oE '\b(yes|no)\b' <<<"$line" | sed 's/yes/satisfied/; s/no/violated/' |
    paste -sd ' ')
[ "$run" = "$compiled" ] || { echo "etlc run: $run; compiled: $compiled"; exit 1; }

# A wrong call and a folder that cannot be made are errors.
status=0
"$program" one 9 >/dev/null 2>err.txt || status=$?
[ "$status" = 2 ] && grep -q usage err.txt || { echo "two arguments: status $status"; exit 1; }
status=0
"$program" one.txt/folder >/dev/null 2>err.txt || status=$?
[ "$status" = 1 ] && grep -q one.txt err.txt || { echo "no folder: status $status"; exit 1; }
