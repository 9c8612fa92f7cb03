# As reported by etlc-embed.
. "$SPECS/../encoding.bash"
echo > ep.mp4
decodes 66 "has 25 frames a second, expected a multiple of the 10 steps of the spec"
sed -i 's/^images)/images) trap "exit 0" EXIT;/' embedder
embeds_each --data ep.mp4 -o out
# Times of a trace that do not fit the rate: a lost row, a row twice, another rate; in any unit, and
# where some are missing. Every reader of episodes looks at them.
cat > t.etl <<'EOF'
spec t;
rate 10 Hz;
input x : f32;
predicate a = x > 0;
monitor m = F a;
EOF
trace() { # NAME AWK: the times of rows t = 0 to 399
    awk -v OFS=, -v OFMT=%.15g "function row(time) { print t, time } BEGIN { print \"x,time\"
        for (t = 0; t < 400; t++) { $2 } }" > "$1.csv"
}
trace even 'row(t / 10)'
trace stamps 'row(1732772693000 + 100 * t + (t % 3))'
trace gaps 'row(t % 2 ? "" : t / 10)'
trace clock 'row("12:30:" t / 10)'
trace slower 'row(t * 0.1003)'
trace lost 'if (t != 200) row(t / 10)'
trace twice 'row(t / 10); if (t == 200) row(t / 10)'
trace fast 'row(t / 11)'
trace back 'row(t < 200 ? t / 10 : t / 10 - 20)'
trace far 'row(t < 200 ? 100 * t : 100 * t + 18814000)'
for each in even stamps gaps clock slower lost twice fast back far; do
    "$ETLC" run t.etl --trace $each.csv -o "$each.out"
done
"$ETLC" run t.etl --trace - -o lost.out < lost.csv
sed 's/rate 10 Hz;//' t.etl > free.etl
"$ETLC" run free.etl --trace lost.csv -o lost.out
"$ETLC" evaluate t.etl --data even.csv lost.csv
ls
