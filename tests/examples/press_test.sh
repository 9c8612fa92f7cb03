#!/usr/bin/env bash
# press_test.sh ETLC SOURCE: the specs of examples/press compile, with made-up embeddings in place
# of the recordings, which are not here; in each episode of its labels the lamp lights while the
# hand is there.
set -euo pipefail
etlc=$1 press=$2/examples/press
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
awk -F , 'NR == 1 { if ($0 != "episode,predicate,start,end") exit 1; next }
    $2 == "hand" { hand = $1; start = $3; end = $4; next }
    !($2 == "lit" && $1 == hand && start < $3 && $3 < end && $4 == "") { print; exit 1 }
    { ++episodes }
    END { if (episodes != 43) { print episodes " episodes"; exit 1 } }' "$press/labels.csv"

cd "$folder"
cp "$press"/*.etl .
echo model >mobilenet_v2.onnx
mkdir episodes
echo episode,predicate,start,end >episodes/labels.csv
for n in {1..12}; do
    awk -v seed="$n" 'BEGIN {
        srand(seed)
        for (i = 0; i < 1280; ++i) printf "z[%d]%s", i, i < 1279 ? "," : "\n"
        for (step = 0; step < 12; ++step)
            for (i = 0; i < 1280; ++i)
                printf "%.3f%s", rand() + (i % 2 == 0 && step >= 3 && step < 9) + \
                       (i % 3 == 0 && step >= 6), i < 1279 ? "," : "\n" }' >"episodes/$n.csv"
    printf '%s,hand,3,9\n%s,lit,6,\n' "$n" "$n" >>episodes/labels.csv
done
for spec in means press; do
    # 1280 numbers for each of the five frames that an encoder gets
    "$etlc" embed $spec.etl --encoder-cmd \
        "cat >/dev/null; printf '\\000\\005\\000\\000'; head -c 25600 /dev/zero"
    "$etlc" fit $spec.etl --data episodes/1[0-2].csv --labels episodes/labels.csv
    "$etlc" calibrate $spec.etl --data episodes/[1-9].csv --labels episodes/labels.csv
    "$etlc" $spec.etl -o $spec.hpp
    grep -q "namespace press" $spec.hpp
done
