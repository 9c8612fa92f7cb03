# A header whose window counts a step too early, and the input that shows it.
cat > soon.etl <<'SPEC'
spec soon;
input x : f32 in [-1, 1];
monitor answer = G (x < 0 -> F[0, 3] x > 0.5);
SPEC
"$ETLC" soon.etl -o soon.hpp
sed 's/position_ >= 3/position_ >= 2/' soon.hpp > wrong.hpp
"$ETLC" prove soon.etl --header wrong.hpp
cat soon.counterexample.csv
"$ETLC" run soon.counterexample.etl --trace soon.counterexample.csv
