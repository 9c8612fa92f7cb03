# Not a part, a cut one, and a changed one; the originals are merged.
. "$SPECS/../shards.bash"
"$ETLC" merge 1.part 2.part -o out.json
rm out.json
"$ETLC" merge 1.part t.etl -o out.json
cp 2.part whole
head -c 60 whole > 2.part
"$ETLC" merge 1.part 2.part -o out.json
{ head -c 60 whole; printf '~'; tail -c +62 whole; } > 2.part
"$ETLC" merge 1.part 2.part -o out.json
ls out.json
