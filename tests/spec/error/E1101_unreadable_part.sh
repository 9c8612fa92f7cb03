# A missing part, and a folder.
. "$SPECS/../shards.bash"
"$ETLC" merge 1.part 3.part -o out.json
mkdir folder
"$ETLC" merge 1.part folder -o out.json
ls out.json
