#!/usr/bin/env bash
# generated_is_fresh_test.sh ETLC SPEC HEADER OPTION...: the committed HEADER equals the output of
# etlc for SPEC, byte for byte. ETLC_UPDATE=1 rewrites it.
set -euo pipefail
etlc=$1 spec=$2 header=$3
shift 3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

made=$folder/$(basename "$header")
if [ $# -eq 0 ]; then
    "$etlc" "$spec" -o "$made"
else
    "$etlc" "$spec" "$@" -o - >"$made"
fi
if [ "${ETLC_UPDATE:-}" = 1 ]; then
    cp "$made" "$header"
elif ! diff -u "$header" "$made"; then
    echo "generated/$(basename "$header") is stale: run the tests with ETLC_UPDATE=1 and commit it"
    exit 1
fi
# Only the header: neither example needs a file of targets.
if [ "$(ls "$folder")" != "$(basename "$header")" ]; then
    echo "more than the header came out:"
    ls "$folder"
    exit 1
fi
