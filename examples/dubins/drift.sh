#!/usr/bin/env bash
# drift.sh ETLC DUBINS_RECORD FOLDER [SEED]: a camera whose mount gives way, watched with a fixed
# and an adaptive threshold. Both are calibrated on 120 drives with the new camera. Then the
# compiled class sees 300 other drives, with labels two seconds late. All files stay in FOLDER.
set -euo pipefail
etlc=$1 record=$2 folder=$3 seed=${4:-1}
here=$(dirname "${BASH_SOURCE[0]}")
later=$((seed + 1000))  # drives with another seed

[ -d "$folder/$seed/calibration" ] || "$record" "$folder" "$seed"
"$record" --sagging "$folder" "$later"
"$etlc" calibrate "$here/drift.etl" --data "$folder/$seed/calibration" \
    -o "$folder/drift.thresholds.json" >"$folder/drift.txt"
"$etlc" "$here/drift.etl" --thresholds "$folder/drift.thresholds.json" -o "$folder/drift.hpp"
"${CXX:-c++}" -std=c++17 -O2 -I "$here/../../runtime/include" -I "$folder" "$here/drift.cpp" \
    -o "$folder/drift"
"$folder/drift" "$folder/$later/sagging"
