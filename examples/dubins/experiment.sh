#!/usr/bin/env bash
# experiment.sh ETLC DUBINS_RECORD FOLDER [SEED...]: the paper's Dubins experiment. For each seed
# (default: 1 to 5) it records 300 drives, calibrates thresholds on 120 of them, by F1 and by
# conformal calibration with alpha = 0.10, and evaluates on the other 180. It prints the mean and
# the standard deviation over the seeds beside the paper's table. All files stay in FOLDER/SEED.
set -euo pipefail
etlc=$1 record=$2 folder=$3
shift 3
[ $# -gt 0 ] || set -- 1 2 3 4 5
spec=$(dirname "${BASH_SOURCE[0]}")/paper.etl

"$record" "$folder" "$@"
results=()
for seed in "$@"; do
    "$etlc" calibrate "$spec" --data "$folder/$seed/calibration" \
        -o "$folder/$seed/thresholds.json" >"$folder/$seed/calibration.txt"
    "$etlc" evaluate "$spec" --data "$folder/$seed/test" \
        --thresholds "$folder/$seed/thresholds.json" \
        --csv "$folder/$seed/evaluation.csv" >"$folder/$seed/evaluation.txt"
    results+=("$folder/$seed/evaluation.csv")
done

awk -F, '
    FNR == 1 { ++seeds; next }
    { key = $2 " " $3 " " $4 }
    $5 != "" { n[key]++; sum[key] += $5; square[key] += $5 * $5 }
    $4 == "true_positives" || $4 == "false_negatives" { positives[$2 " " $3] += $5 }
    $4 ~ /^(true|false)_(positives|negatives)$/ { all[$2 " " $3] += $5 }

    function mean(key) { return n[key] ? sum[key] / n[key] : "none" }
    function spread(key,   v) {
        if (n[key] < 2) return 0
        v = (square[key] - sum[key] * sum[key] / n[key]) / (n[key] - 1)
        return v > 0 ? sqrt(v) : 0
    }
    function figure(key, percent) {
        if (!n[key]) return "-"
        if (percent) return sprintf("%.1f (%.1f) %%", 100 * mean(key), 100 * spread(key))
        return sprintf("%.2f (%.2f)", mean(key), spread(key))
    }
    function line(name, f1, precision, recall, agreement, cp_precision, cp_recall, cp_agreement) {
        printf "%-28s %12s %12s %12s %14s %12s %12s %14s\n", name, f1, precision, recall,
            agreement, cp_precision, cp_recall, cp_agreement
    }
    function row(name, f1, cp, level, paper,   i, p) {
        f1 = f1 " " level; cp = cp " " level
        line(name, figure(f1 " f1"), figure(f1 " precision"), figure(f1 " recall"),
            figure(f1 " agreement", 1), figure(cp " precision"), figure(cp " recall"),
            figure(cp " agreement", 1))
        split(paper, p, " ")
        line("  the paper", p[1], p[2], p[3], p[4] " %", p[5], p[6], p[7] " %")
    }
    END {
        printf "%d seeds, for each 120 drives to calibrate on ", seeds
        printf "and 180 others to evaluate on; mean (standard deviation) over the seeds\n\n"
        line("", "F1", "precision", "recall", "agreement",
            "CP precision", "CP recall", "CP agreement")
        row("Reach A (frames)", "a_f1", "a_cp", "frames", "0.85 0.87 0.83 98.6 0.79 0.93 98.5")
        row("Avoid C (frames)", "c_f1", "c_cp", "frames", "0.80 0.69 0.94 96.5 0.70 0.92 96.5")
        row("Reach-avoid (frames)", "clear_a_f1", "clear_a_cp", "steps",
            "0.85 0.87 0.83 98.6 0.79 0.93 98.5")
        row("Sequential A to B (episodes)", "sequential_f1", "sequential_cp", "episodes",
            "1.00 1.00 1.00 100 1.00 1.00 100")
        printf "\nframes inside A: %d of %d, inside C: %d; drives that visit A, then B: %d of %d",
            positives["a_f1 frames"], all["a_f1 frames"], positives["c_f1 frames"],
            positives["sequential_f1 episodes"], all["sequential_f1 episodes"]
        printf ", that reach A: %d, that stay clear of C: %d\n",
            positives["reach_f1 episodes"], positives["avoid_f1 episodes"]
        both = all["sequential_f1 ordering"]
        printf "both goals visited: %d drives, of these in the other order: %d; ",
            both, both - positives["sequential_f1 ordering"]
        printf "agreement on the order: %s by F1, %s by conformal thresholds\n",
            figure("sequential_f1 ordering agreement", 1),
            figure("sequential_cp ordering agreement", 1)
        printf "drives without a missed frame, by conformal thresholds "
        printf "(promised: 90 %% on average): of A %s, of B %s, of C %s\n",
            figure("a_cp frames coverage", 1), figure("b_cp frames coverage", 1),
            figure("c_cp frames coverage", 1)
    }' "${results[@]}"
