# Nesting 100 000 deep, in every way that the grammar allows, is refused quickly.
repeat() { printf "%.0s$1" $(seq 100000); }
spec() { printf 'spec t;\ninput x : f32;\npredicate p = x > 0;\n%s\n' "$1"; }
spec "monitor m = $(repeat '(')p$(repeat ')');" > brackets.etl
spec "monitor m = $(repeat '!')p;" > prefixes.etl
spec "monitor m = $(repeat 'F ')p;" > futures.etl
spec "monitor m = $(repeat 'p -> ')p;" > implications.etl
spec "monitor m = $(repeat 'p <-> ')p;" > equivalences.etl
spec "monitor m = $(repeat 'x + ')x > 1;" > sums.etl
spec "monitor m = $(repeat 'abs(')x$(repeat ')') > 1;" > calls.etl
for file in *.etl; do
    timeout 60 "$ETLC" "$file" --check 2>&1 | cut -c 1-120
done
