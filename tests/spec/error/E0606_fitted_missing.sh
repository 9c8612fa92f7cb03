# Results that `etlc fit` has not made yet: an error, but a note with --check.
cat > t.etl <<'END'
spec t;
input z : f32[2];
input up : bool;
target held = fitted(mean, of = z, where = up);
predicate p = l2(z, held) <= 1;
monitor m = F p;
END
"$ETLC" t.etl -o t.hpp
echo "exit status $?"
"$ETLC" t.etl --check
echo "exit status $?"
"$ETLC" t.etl --check --fitted later.npz
cp "$SPECS/../ok/projections.fitted.npz" t.fitted.npz
"$ETLC" t.etl -o t.hpp
