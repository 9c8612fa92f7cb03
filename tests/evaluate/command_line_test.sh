#!/usr/bin/env bash
# command_line_test.sh ETLC FOLDER DATA: `etlc evaluate` from end to end: its table, CSV and JSON,
# alike for any number of threads; episodes in an .h5 file; a call that is wrong.
set -euo pipefail
etlc=$1 expected=$2 data=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
fail() { echo "FAILED: $*"; exit 1; }

cat >dock.etl <<'SPEC'
spec dock;
rate 10 Hz;
input z  : f32[2];
input px : f32;
target goal = [[1, 1]];
predicate near = l2(z, goal) <= 0.5;
truth near = px > 0;
monitor arrive = F near;
monitor twice = F (near && F (px < 0));
SPEC
mkdir episodes
for e in 0 1 2 3 4 5; do
    awk -v e=$e 'BEGIN {
        print "px,z[0],z[1]"
        for (t = 0; t < 12; ++t) {
            px = (t * (e + 3)) % 7 - 3.5
            z = px > 0 || (t + e) % 5 == 0 ? 1.25 : 3
            print px "," z ",1"
        }
    }' >episodes/$e.csv
done

for jobs in 1 4; do
    "$etlc" evaluate dock.etl --data episodes -j $jobs --json $jobs.json --csv $jobs.csv >$jobs.txt
    "$etlc" evaluate dock.etl --data 'episodes/*.csv' -j $jobs --json - >alone.json
    cmp $jobs.json alone.json
done
cmp 1.txt 4.txt && cmp 1.csv 4.csv && cmp 1.json 4.json
for form in txt csv json; do
    if [ "${ETLC_UPDATE:-}" = 1 ]; then cp 1.$form "$expected/dock.expected.$form"; fi
    diff -u "$expected/dock.expected.$form" 1.$form
done

cat >groups.etl <<'SPEC'
spec groups;
input z : f32[3];
target origin = [[0, 0, 0]];
predicate at_a = l2(z, origin) > 3.5;
monitor m = F at_a;
SPEC
"$etlc" evaluate groups.etl --data "$data/trace.h5" --episodes 'data/demo_*[0-9]' --map z=obs/z \
    >groups.txt
grep -q '^3 episodes, 21 frames' groups.txt || fail "$(cat groups.txt)"

sed 's/<= 0.5;/<= calibrated(adaptive, alpha = 0.5, gamma = 0.1, lo = 0, hi = 4);/' dock.etl \
    >adaptive.etl
"$etlc" calibrate adaptive.etl --data episodes/[012].csv >calibrated.txt
"$etlc" evaluate adaptive.etl --data episodes/[345].csv >adaptive.txt
grep -q '^near: with the threshold that it starts with; labels would move it$' adaptive.txt ||
    fail "$(cat adaptive.txt)"

status=0
"$etlc" evaluate dock.etl 2>err.txt || status=$?
[ $status = 2 ] && grep -q -- --data err.txt || fail "no --data: $status, $(cat err.txt)"

# What is not defined is null, and there all the same: here a monitor that misses every turn.
sed 's/<= 0.5;/<= 0;/' dock.etl >blind.etl
"$etlc" evaluate blind.etl --data episodes --json blind.json >blind.txt
grep -q '"mean_seconds": null' blind.json || fail "mean_seconds: $(grep -A8 detection blind.json)"
