# A fit needs frames: at least one, as many as rows, more than components, and for a discriminant
# enough episodes to choose its shrinkage on others than it is fitted on.
fit() {  # DECLARATION POINT EPISODE...
  cat > t.etl <<SPEC
spec t;
input z : f32[3];
input px : f32;
predicate p = px < 1;
$1
target g = fitted(mean, of = $2, where = p);
predicate near = min l2($2, g) <= 1;
monitor m = F near;
SPEC
  "$ETLC" fit t.etl --data "${@:3}"
}
printf 'z[0],z[1],z[2],px\n1,0,0,0\n0,2,0,0\n0,1,,0\n0,1,3,\n5,4,3,2\n' > 1.csv
printf 'z[0],z[1],z[2],px\n1,1,0,3\n0,3,0,2\n4,1,0,2\n' > 2.csv
fit '' z 2.csv
fit 'target some = fitted(medoids, k = 3, of = z, where = p);' z 1.csv 2.csv
fit 'target some = fitted(kmeans, k = 1, away = 3, of = z, where = p);' z 1.csv 2.csv
fit 'projection Q = fitted(pca, r = 3, of = z, where = p);' 'Q(z)' 1.csv
fit 'projection L = fitted(discriminant, r = 1, of = z, where = p);' 'L(z)' 1.csv 2.csv
