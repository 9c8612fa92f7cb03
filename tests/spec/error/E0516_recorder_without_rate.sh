# Durations of a recorder need a rate; steps do not. A recorder counts towards the state.
cat > t.etl <<'END'
spec t;
input grip : f32;
monitor m = G grip > 0.5;
END
"$ETLC" t.etl --recorder 2s,1,4 --check
"$ETLC" t.etl --recorder 20,1s,4 --check
"$ETLC" t.etl --recorder 20,10,4 --check && "$ETLC" t.etl --recorder 20,10,4 --check --max-state 999
