#!/usr/bin/env bash
# tutorial_test.sh ETLC RUNTIME DOCUMENT: the commands of DOCUMENT print what it says they print. A
# fence "NAME file=PATH" becomes a file in an empty folder. In a "console" fence each line that
# begins with "$ " runs there, and the lines up to the next are its output. ETLC_UPDATE=1 rewrites
# the outputs.
set -euo pipefail
PATH=$(dirname "$1"):$PATH
export ETLC_RUNTIME=$2
document=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/work"

fence='' # what the current block is: nothing, a file's path, "console" or "other"
commands=0
while IFS= read -r line; do
    case $fence:$line in
    console:'$ '*)
        echo "$line"
        (cd "$folder/work" && bash -c "${line#$ }" </dev/null 2>&1) || true
        commands=$((commands + 1))
        continue
        ;;
    console:'```') fence='' ;;
    console:*) continue ;; # the output that was committed
    :'```console') fence=console ;;
    :'```'*file=*)
        fence=${line##*file=}
        : >"$folder/work/$fence"
        ;;
    :'```'*) fence=other ;;
    *:'```') fence='' ;;
    :* | other:*) ;;
    *) printf '%s\n' "$line" >>"$folder/work/$fence" ;;
    esac
    printf '%s\n' "$line"
done <"$document" >"$folder/document.md"

[ -z "$fence" ] || { echo "the last block is not closed"; exit 1; }
[ "$commands" -ge 3 ] || { echo "only $commands commands were found"; exit 1; }
if grep -n '^bash: ' "$folder/document.md"; then
    echo "bash cannot run this command, so its output is no example"
    exit 1
fi
if [ "${ETLC_UPDATE:-}" = 1 ]; then
    cp "$folder/document.md" "$document"
else
    diff -u "$document" "$folder/document.md"
fi
