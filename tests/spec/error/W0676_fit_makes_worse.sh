# The labels depend on three elements, and most of the variance is in the first: a principal
# component loses information that the plain distance has.
cat > dock.etl <<'END2'
spec dock;
input z : f32[4];
projection P  = fitted(pca, r = 1, of = z, where = true);
target goal   = fitted(mean, of = P(z), where = docked);
target seen   = fitted(mean, of = z, where = docked);
predicate docked = l2(P(z), goal) <= calibrated(f1);
predicate found  = l2(z, seen) <= calibrated(f1);
monitor m = F docked && F found;
END2
awk 'function r() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
BEGIN { seed = 3
  for (e = 1; e <= 8; e++) { f = "e" e ".csv"
    print "z[0],z[1],z[2],z[3],truth.docked,truth.found" > f
    for (t = 0; t < 20; t++) { y = t % 3 == 0; d = y ? 0 : 2
      printf "%.4f,%.4f,%.4f,%.4f,%d,%d\n", 8 * r() - 4, d + r(), d + r(), d + r(), y, y > f } } }'
"$ETLC" fit dock.etl --data . > report.txt
echo "exit status $?"
grep -A 3 '^  predicate' report.txt
