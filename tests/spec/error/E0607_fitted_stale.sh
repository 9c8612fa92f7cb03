# Numbers fitted for another method, point, truth or shape than the spec now has.
cp "$SPECS/../ok/projections.etl" "$SPECS/../ok/frames.csv" .
changed() {
    sed "$1" projections.etl > t.etl
    cp "$SPECS/../ok/projections.fitted.npz" t.fitted.npz
    "$ETLC" t.etl --check
}
changed 's/kmeans, k = 2/kmeans, k = 3/'
changed 's/up = lift > 0.1/up = lift > 0.2/'
changed 's/\[\[1, 0, 0\]/[[2, 0, 0]/'
cat > t.etl <<'END'
spec t;
rate 20 Hz;
input z : f32[2];
input up : bool;
target mean_z = fitted(mean, of = z, where = O[0, 0.5 s] up);
monitor m = F l2(z, mean_z) < 1;
END
"$ETLC" t.etl --check
