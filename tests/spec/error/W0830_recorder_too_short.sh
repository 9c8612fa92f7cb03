# The step that a sliding monitor's alarm is about, and a recorder that just includes it.
cat > t.etl <<'END'
spec t;
rate 10 Hz;
input grip : f32;
sliding monitor held = F[0, 1 s] grip > 0.5;
END
"$ETLC" t.etl --recorder 0.9s,1s,4 --check
"$ETLC" t.etl --recorder 0.95s,1s,4 --check
