# A spec of 10 MB is refused by its size, whatever its content; so is one that is a byte too long.
# One below the limit is read.
head='spec t;\ninput x : f32;\nlet l0 = x > 0;\n'
{ printf "$head"; head -c 10000000 /dev/zero | tr '\0' ' '; } > blank.etl
{ printf "$head"; yes 'predicate p = x > 0;' | head -c 10000000; } > declarations.etl
{ printf "$head"; yes ' ' | head -c 2000000; } | head -c 1048577 > edge.etl
{ printf "$head"; for i in $(seq 40000); do echo "let l$i = l$((i - 1));"; done; echo \
    'monitor m = G l40000;'; } > lets.etl
for file in blank declarations edge lets; do
    echo "$file: $(stat -c %s $file.etl) bytes"
    timeout 60 "$ETLC" "$file.etl" --check 2>&1 | cut -c 1-120 | head -5
done
