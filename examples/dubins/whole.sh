#!/usr/bin/env bash
# whole.sh ETLC DUBINS_RECORD FOLDER [SEED...]: compares the guarantee of a formula by the union
# bound over its predicates with calibrating the monitor as a whole, for each seed (default: 1 to 5)
# on the drives of experiment.sh. Both calibrate on the same 120 drives; as a whole, 60 of them give
# the thresholds and the other 60 the shift. It prints the errors on 180 others.
set -euo pipefail
etlc=$1 record=$2 folder=$3
shift 3
[ $# -gt 0 ] || set -- 1 2 3 4 5
here=$(dirname "${BASH_SOURCE[0]}")

results=()
for seed in "$@"; do
    drives=$folder/$seed
    [ -d "$drives/calibration" ] || "$record" "$folder" "$seed"
    mapfile -t all < <(printf '%s\n' "$drives"/calibration/*.csv)
    "$etlc" calibrate "$here/union.etl" --data "${all[@]}" -o "$drives/union.thresholds.json" \
        >"$drives/union.txt"
    "$etlc" calibrate "$here/whole.etl" --data "${all[@]:0:60}" -o "$drives/predicates.json" \
        >"$drives/predicates.txt"
    "$etlc" calibrate "$here/whole.etl" --data "${all[@]:60}" \
        --thresholds "$drives/predicates.json" -o "$drives/whole.thresholds.json" \
        >"$drives/whole.txt"
    for spec in union whole; do
        "$etlc" "$here/$spec.etl" --thresholds "$drives/$spec.thresholds.json" \
            -o "$drives/$spec.hpp"
    done
    "${CXX:-c++}" -std=c++17 -O2 -I "$here/../../runtime/include" -I "$drives" "$here/whole.cpp" \
        -o "$drives/whole"
    "$drives/whole" "$drives/test" >"$drives/whole.csv"
    results+=("$drives/whole.csv")
done

awk -F, '
    FNR == 1 { ++seeds; next }
    { key = $1 " " $2; n[key] += $3; stake[key] += $4; missed[key] += $5; other[key] += $6 }
    function row(monitor, error, cost, by, key) {
        key = by " " monitor
        printf "%-12s %-12s %17s %4d of %4d (%4.1f %%)", monitor, by,
            error, missed[key], stake[key], 100 * missed[key] / stake[key]
        printf " %20s %4d of %4d (%4.1f %%)\n", cost, other[key], n[key],
            100 * other[key] / n[key]
    }
    END {
        printf "%d seeds, 180 drives each; drives in which some verdict is wrong. ", seeds
        printf "Promised: at most 10 %% miss\n\n"
        row("sequential", "misses a success", "unfounded success", "union")
        row("sequential", "misses a success", "unfounded success", "whole")
        row("in_order", "misses an alarm", "false alarm", "union")
        row("in_order", "misses an alarm", "false alarm", "whole")
    }' "${results[@]}"
