#!/usr/bin/env bash
# dubins_test.sh PROGRAM ETLC SPEC: the demo runs, twice the same, agrees with the truth in most
# drives, and `etlc run` on the recorded drive says what the compiled monitor said.
set -euo pipefail
program=$1 etlc=$2 spec=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

"$program" one 9 >one.txt
"$program" two 9 >two.txt
diff <(sed 's#one/#FOLDER/#g' one.txt) <(sed 's#two/#FOLDER/#g' two.txt)
cmp one/dubins.svg two/dubins.svg
cmp one/dubins.csv two/dubins.csv

[ "$(grep -cE '^ +[0-9]+  [A-Z]' one.txt)" = 100 ] ||
    { echo "not a line for each of 100 drives"; exit 1; }
for monitor in reach avoid reach_avoid sequential; do
    agreeing=$(sed -nE "s/^$monitor +([0-9]+) of 100 .*/\1/p" one.txt)
    [ "${agreeing:-0}" -ge 90 ] ||
        { echo "$monitor agrees with the truth in ${agreeing:-no} drives of 100"; exit 1; }
done
if grep -q $'\e' one.txt; then echo "colour in a file"; exit 1; fi

# The thresholds that the demo draws and counts with are those of the spec.
for literal in $(sed -nE 's/^predicate .*<= ([0-9.]+);.*/\1/p' "$spec"); do
    grep -q ">threshold $literal<" one/dubins.svg ||
        { echo "threshold $literal of the spec is not in the picture"; exit 1; }
done

# The last verdict of each monitor on the recorded drive, by the plan and by the compiled code.
"$etlc" run "$spec" --trace one/dubins.csv -o verdicts.csv
run=$(awk -F, '
    NR > 1 { last[$2] = $6 }
    END { print last["reach"], last["avoid"], last["reach_avoid"], last["sequential"] }
' verdicts.csv)
line=$(grep -E '^ +9  ' one.txt)
compiled=$(grep -oE '\b(yes|no)\b' <<<"$line" | sed 's/yes/satisfied/; s/no/violated/' |
    paste -sd ' ')
[ "$run" = "$compiled" ] || { echo "etlc run: $run; compiled: $compiled"; exit 1; }

# A wrong call is refused.
for call in '101' '0' '9x'; do
    status=0
    "$program" one "$call" >/dev/null 2>err.txt || status=$?
    [ "$status" = 2 ] && grep -q "from 1 to 100" err.txt ||
        { echo "drive $call: status $status"; exit 1; }
done
