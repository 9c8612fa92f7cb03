#!/usr/bin/env bash
# dubins_whole_test.sh RECORD ETLC SOURCE COMPILER: runs whole.sh and both.sh for one seed.
# Calibrated as a whole, the monitors miss about as often as allowed, and err the other way no more
# often than with the union bound.
set -euo pipefail
record=$1 etlc=$2 source=$3 compiler=$4
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

CXX=$compiler "$source/examples/dubins/whole.sh" "$etlc" "$record" "$folder" 1 >"$folder/printed"
cat "$folder/printed" "$folder/1/whole.csv"
awk -F, '
    FNR > 1 { share = $5 / $4; other[$1 " " $2] = $6; ++rows }
    # One set of 60 drives: the coverage has a Beta distribution with 5 % quantile of about 0.82,
    # and 180 drives measure it.
    FNR > 1 && share > ($1 == "whole" ? 0.3 : 0.2) { wrong = $1 " " $2 " misses too much" }
    END {
        if (rows != 4) wrong = "there are not four rows"
        for (monitor in other) {
            if (monitor !~ /^whole/) continue
            by_union = monitor
            sub(/whole/, "union", by_union)
            if (other[monitor] > other[by_union]) wrong = monitor " loses"
        }
        if (other["whole sequential"] * 2 > other["union sequential"])
            wrong = "sequential gains nothing"
        if (wrong != "") { print wrong; exit 1 }
    }' "$folder/1/whole.csv"

# The same drives with both.sh. Where at most a tenth of the drives has an error, so has at most a
# tenth of the steps; against both errors some frames and steps are unknown, and few.
"$source/examples/dubins/both.sh" "$etlc" "$record" "$folder" 1 >"$folder/printed"
cat "$folder/printed"
awk '
    NR > 1 { ++rows; at = NF - ($1 ~ /^at_/ ? 1 : 10); method = $1 " " $2 " " $3 }
    NR > 1 && / both / && ($(at - 4) > 10 || $(at - 2) > 10) { wrong = method " errs too often" }
    NR > 1 && / both / && !/whole/ && !($at > 0 && $at < 10) { wrong = method " has another cost" }
    NR > 1 && !/ both / && $at != 0 { wrong = method " is unknown" }
    END {
        if (rows != 18) wrong = "there are not 18 rows"
        if (wrong != "") { print wrong; exit 1 }
    }' "$folder/printed"
