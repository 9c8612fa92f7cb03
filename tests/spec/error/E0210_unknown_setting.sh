# --set of a name that is not a constant, or with another kind of value; and values that are invalid
# where the constant is used.
cat > t.etl <<'END'
spec t;
const limit = 0.5;
const deadline = 0.3 s;
rate 10 Hz;
input x : f32;
monitor m = F[0, deadline] x > limit;
END
"$ETLC" t.etl --check --set limt=1 --set x=2 --set limit=1s --set deadline=3
echo "exit status $?"
"$ETLC" t.etl --check --set limit=1e50 --set deadline='250 ms'
echo "exit status $?"
for words in limit limit=x limit=1.s '=3' limit=; do "$ETLC" t.etl --check --set "$words"; done
"$ETLC" t.etl --check --set limit=1 --set limit=2
echo "exit status $?"
"$ETLC" --set limit=-2e-1 t.etl --check
