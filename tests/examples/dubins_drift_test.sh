#!/usr/bin/env bash
# dubins_drift_test.sh RECORD ETLC SOURCE COMPILER: drift.sh runs, the fixed threshold loses its
# coverage, the adaptive one regains it, and its misses are within the bound that the header gives.
set -euo pipefail
record=$1 etlc=$2 source=$3 compiler=$4
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

CXX=$compiler "$source/examples/dubins/drift.sh" "$etlc" "$record" "$folder" >"$folder/printed"
cat "$folder/printed"
awk '
    $2 == "to" {
        ++parts
        fixed = $5; adaptive = $7
        if ($1 <= 61 && fixed > 5) wrong = "the fixed threshold misses before the drift"
        if ($1 > 211 && (fixed < 15 || adaptive > 12)) wrong = "coverage is not lost and restored"
    }
    /were labelled/ {
        labelled = $1
        for (i = 1; i <= NF; ++i) if ($i == "missed") missed = $(i + 1)
    }
    END {
        if (parts != 10) wrong = "there are not ten parts"
        if (labelled < 2000 || missed > 0.1 * labelled + 74.7) wrong = "the bound does not hold"
        if (wrong != "") { print wrong; exit 1 }
    }' "$folder/printed"
grep -q 'a_adaptive  0.10 T + 74.7 + 0.9 H' "$folder/drift.hpp"
