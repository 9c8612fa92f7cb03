#!/usr/bin/env bash
# both.sh ETLC DUBINS_RECORD FOLDER [SEED...]: compares guarantees on one error, on both, and on
# shares, each with alpha = 0.1, for each seed (default: 1 to 5) on the drives of experiment.sh. The
# specs are union.etl and whole.etl with another `calibrated(...)`. It prints the errors on the 180
# test drives of each seed, all seeds together.
set -euo pipefail
etlc=$1 record=$2 folder=$3
shift 3
[ $# -gt 0 ] || set -- 1 2 3 4 5
here=$(dirname "${BASH_SOURCE[0]}")
mkdir -p "$folder"
cp -r "$here/targets" "$folder"

results=()
for kind in one-sided both risk; do
    # One-sided, predicates are calibrated against misses, and each monitor as whole.etl says.
    case $kind in
        one-sided) predicates="conformal, alpha = 0.1" monitors="$predicates, \\1" ;;
        both) predicates="conformal, alpha = 0.1, against = both" monitors=$predicates ;;
        risk) predicates="risk, alpha = 0.1, against = both" monitors=$predicates ;;
    esac
    sed "s/conformal, alpha = 0.05/$predicates/" "$here/union.etl" >"$folder/union_$kind.etl"
    sed "s/conformal, alpha = 0.10, \(against = [a-z_]*\)/$monitors/" "$here/whole.etl" \
        >"$folder/whole_$kind.etl"
    for seed in "$@"; do
        drives=$folder/$seed
        [ -d "$drives/calibration" ] || "$record" "$folder" "$seed"
        mapfile -t all < <(printf '%s\n' "$drives"/calibration/*.csv)
        [ -f "$drives/predicates.json" ] ||
            "$etlc" calibrate "$here/whole.etl" --data "${all[@]:0:60}" \
                -o "$drives/predicates.json" >"$drives/predicates.txt"
        for spec in union whole; do
            calibrated=("${all[@]}") before=()
            if [ $spec = whole ]; then
                calibrated=("${all[@]:60}") before=(--thresholds "$drives/predicates.json")
            fi
            out=$drives/${spec}_$kind
            "$etlc" calibrate "$folder/${spec}_$kind.etl" --data "${calibrated[@]}" \
                "${before[@]}" -o "$out.thresholds.json" >"$out.txt" 2>&1
            "$etlc" evaluate "$folder/${spec}_$kind.etl" --thresholds "$out.thresholds.json" \
                --data "$drives/test" --variants cut --csv "$out.csv" >/dev/null 2>&1
            results+=("$out.csv")
        done
    done
done

awk -F, '
    # union_both.csv holds the predicates, and the monitors that rest on them.
    FNR == 1 { n_of = split(FILENAME, of, /[\/_.]/); spec = of[n_of - 2]; kind = of[n_of - 1] }
    $1 == "monitor" || spec == "union" { n[$2, spec, kind, $3, $4] += $5 }

    function count(level, what) { return n[name, spec, kind, level, what] }
    function yes(level) {
        return count(level, "true_positives") + count(level, "false_negatives") \
            + count(level, "unknown_positives")
    }
    function no(level) {
        return count(level, "true_negatives") + count(level, "false_positives") \
            + count(level, "unknown_negatives")
    }
    function share(part, all) { return sprintf("%.2f %%", 100 * part / all) }
    function not_satisfied(level) { return no(level) - count(level, "false_positives") }
    function row(level) {
        printf "%-18s %-9s %18s %18s %8s", name (spec == "whole" ? ", whole" : ""), kind,
            share(count(level, "false_negatives"), yes(level)),
            share(count(level, "false_positives"), no(level)),
            share(count(level, "unknown_positives") + count(level, "unknown_negatives"),
                yes(level) + no(level))
        if (level == "steps")
            printf " %10s %12s %14s", count("episodes", "true_positives") " of " yes("episodes"),
                not_satisfied("episodes") " of " no("episodes"),
                not_satisfied("cut") " of " no("cut")
        print ""
    }
    function rows(a, b, level,   i) {
        name = a; spec = b
        for (i = 1; i <= 3; i++) { kind = kinds[i]; row(level) }
    }
    END {
        split("one-sided both risk", kinds, " ")
        printf "%-18s %-9s %18s %18s %8s %10s %12s %14s\n", "", "", "false though true",
            "true though false", "unknown", "successes", "failures", "cut variants"
        rows("at_a", "union", "frames")
        rows("at_b", "union", "frames")
        rows("sequential", "union", "steps")
        rows("sequential", "whole", "steps")
        rows("in_order", "union", "steps")
        rows("in_order", "whole", "steps")
    }' "${results[@]}"
