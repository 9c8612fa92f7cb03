# What a prefix has to foresee, a sliding monitor looks back at, for far less.
cat > t.etl <<'SPEC'
spec t;
input x, y, w : f32;
predicate p = x > 0;
predicate q = y > 0;
predicate r = w > 0;
monitor m = F (p && G[0, 100] (q || F[0, 50] r));
SPEC
"$ETLC" t.etl --check --max-work 5000
sed 's/= F .*/= G (p -> F[0, 400] (q \&\& F[0, 400] (r \&\& F[0, 400] p)));/' t.etl > u.etl
"$ETLC" u.etl --check --max-work 5000
