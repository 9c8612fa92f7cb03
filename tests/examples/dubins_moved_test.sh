#!/usr/bin/env bash
# dubins_moved_test.sh RECORD ETLC SOURCE COMPILER: moved.sh runs; the camera that gives way from
# drive 101 on is noticed before drive 250 by the average, and later by single pictures; a camera
# that stays raises no alarm.
set -euo pipefail
record=$1 etlc=$2 source=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

"$source/examples/dubins/moved.sh" "$etlc" "$record" "$folder" >"$folder/printed"
cat "$folder/printed"
awk '
    /^[0-9]/ { sags = /sagging/ }
    /drift/ {
        ++lines
        alarm = $3 == "ALARM" ? $5 : 999
        if (!sags && alarm < 999) wrong = "an alarm without reason"
        if (sags && /camera_moved/ && (alarm < 110 || alarm > 250)) wrong = "not noticed in time"
        if (sags) at[$2] = alarm
    }
    END {
        if (lines != 6) wrong = "there are not six drifts"
        if (at["camera_moved:"] > at["by_one_frame:"]) wrong = "the worst picture says more"
        if (wrong != "") { print wrong; exit 1 }
    }' "$folder/printed"
