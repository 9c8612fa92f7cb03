# A compiler whose window counts a step too early, and the input that shows it.
cat > soon.etl <<'SPEC'
spec soon;
input x : f32 in [-1, 1];
monitor answer = G (x < 0 -> F[0, 3] x > 0.5);
SPEC
cat > compiler <<'SCRIPT'
#!/bin/sh
sed -i 's/position_ >= 3/position_ >= 2/' */class.hpp
exec c++ "$@"
SCRIPT
chmod +x compiler
CXX="$PWD/compiler" "$ETLC" prove soon.etl
cat soon.counterexample.csv
"$ETLC" run soon.counterexample.etl --trace soon.counterexample.csv
