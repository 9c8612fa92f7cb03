#!/usr/bin/env bash
# moved.sh ETLC DUBINS_RECORD FOLDER [SEED]: a camera whose mount gives way, noticed without labels.
# What is usual is learned from 180 drives with the new camera, and calibrated on 120 others. Then
# 300 drives follow, over whose second hundred the picture moves; and 300 from a camera that stays.
# All files stay in FOLDER.
set -euo pipefail
etlc=$1 record=$2 folder=$3 seed=${4:-1}
here=$(dirname "${BASH_SOURCE[0]}")
later=$((seed + 1000)) other=$((seed + 2000))  # drives with other seeds

[ -d "$folder/$seed/calibration" ] || "$record" "$folder" "$seed"
[ -d "$folder/$later/sagging" ] || "$record" --sagging "$folder" "$later"
[ -d "$folder/$other/calibration" ] || "$record" "$folder" "$other"
"$etlc" fit "$here/moved.etl" --data "$folder/$seed/test" -o "$folder/moved.fitted.npz" \
    >"$folder/fitted.txt"
files=(--fitted "$folder/moved.fitted.npz")
"$etlc" calibrate "$here/moved.etl" "${files[@]}" --data "$folder/$seed/calibration" \
    -o "$folder/moved.thresholds.json" >"$folder/moved.txt"
files+=(--thresholds "$folder/moved.thresholds.json")
for drives in "$later/sagging" "$other/calibration" "$other/test"; do
    echo "$drives"
    "$etlc" run "$here/moved.etl" "${files[@]}" --data "$folder/$drives" --summary \
        -o "$folder/rows.csv" >"$folder/run.txt"
    awk '/\.csv$/ { drive = $1; sub(".*/", "", drive) }
         /^as_usual: violated for good/ { ++violated }
         /^drift / { last[$2] = $0; if (/ALARM/ && !($2 in at)) at[$2] = drive }
         END { print "  " violated + 0 " drives with an alarm of as_usual"
               for (name in last) print "  " last[name] (name in at ? ", since " at[name] : "") }' \
        "$folder/run.txt" | LC_ALL=C sort
done
