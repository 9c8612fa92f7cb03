# A class that branches on truth values, and a header that does not compile.
cat > soon.etl <<'SPEC'
spec soon;
input x : f32 in [-1, 1];
monitor answer = G (x < 0 -> F[0, 3] x > 0.5);
SPEC
"$ETLC" prove soon.etl --values boolean
echo 'namespace soon { class Monitor; }' > soon.hpp
"$ETLC" prove soon.etl --header soon.hpp
