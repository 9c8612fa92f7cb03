# A compiler that compiles nothing, and headers that are not what etlc generates: edited, cut, or
# made with other options or from another spec.
cat > soon.etl <<'SPEC'
spec soon;
input x : f32 in [-1, 1];
monitor answer = G (x < 0 -> F[0, 3] x > 0.5);
SPEC
"$ETLC" soon.etl -o soon.hpp
"$ETLC" prove soon.etl --header soon.hpp | sed -n '/^proved for all inputs/p; /^scope/p'
sed 's/position_ >= 3/position_ >= 2/' soon.hpp > edited.hpp
"$ETLC" prove soon.etl --header edited.hpp
sed 's/$/\r/' soon.hpp > dos.hpp
"$ETLC" prove soon.etl --header dos.hpp
head -c -1 soon.hpp > cut.hpp
"$ETLC" prove soon.etl --header cut.hpp
cp soon.hpp long.hpp
echo >> long.hpp
"$ETLC" prove soon.etl --header long.hpp
"$ETLC" prove soon.etl --header soon.hpp --explain
"$ETLC" soon.etl --standalone -o whole.hpp
"$ETLC" prove soon.etl --header whole.hpp
sed 's/0.5/0.25/' soon.etl > other.etl
"$ETLC" other.etl -o other.hpp
"$ETLC" prove soon.etl --header other.hpp
CXX=false "$ETLC" prove soon.etl
"$ETLC" prove soon.etl --header missing.hpp
