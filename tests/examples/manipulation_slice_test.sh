#!/usr/bin/env bash
# manipulation_slice_test.sh ETLC SOURCE: fits, calibrates and evaluates pick_place.etl on the few
# episodes of examples/manipulation/slice. The fitted distances rank other episodes far better than
# plain ones, and the monitors agree with the truth.
set -euo pipefail
etlc=$1 slice=$2/examples/manipulation/slice
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
spec=$folder/pick_place.etl
cp "$2/examples/manipulation/pick_place.etl" "$spec"

"$etlc" fit "$spec" --data "$slice/fit" >"$folder/fit"
"$etlc" calibrate "$spec" --data "$slice/calibration"
"$etlc" evaluate "$spec" --data "$slice/tests" --csv - >"$folder/figures"
cat "$folder/fit" "$folder/figures"

# at_least FIGURE LEAST: a figure of 'etlc evaluate' is at least LEAST.
at_least() {
    awk -F , -v name="$1," -v least="$2" '
        index($0, name) == 1 { found = 1; if ($5 + 0 < least) { print "too low: " $0; exit 1 } }
        END { if (!found) { print "no line begins with " name; exit 1 } }' "$folder/figures"
}
at_least predicate,grasped,frames,auroc 0.95
at_least predicate,placed,frames,auroc 0.98
at_least monitor,done,episodes,f1 0.9
at_least monitor,place_first,episodes,f1 0.9
sed -n '/^  predicate/,/^plain/p' "$folder/fit" | awk '
    $1 == "grasped" || $1 == "placed" {
        ++rows
        if ($5 + 0 < $2 + 0.05) { print "not better than plain: " $0; wrong = 1 }
    }
    END { exit wrong || rows != 2 }'
