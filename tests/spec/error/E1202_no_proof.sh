# A header that contains the runtime, and one of another spec.
cat > soon.etl <<'SPEC'
spec soon;
input x : f32 in [-1, 1];
monitor answer = G (x < 0 -> F[0, 3] x > 0.5);
SPEC
"$ETLC" soon.etl --standalone -o soon.hpp
"$ETLC" prove soon.etl --header soon.hpp
echo 'namespace other {}' > soon.hpp
"$ETLC" prove soon.etl --header soon.hpp | grep -o '.*for a proof'
"$ETLC" prove soon.etl --header missing.hpp
