cat > t.etl <<'END'
spec t;
input z : f32[1];
target goal = [[1]];
predicate a = l2(z, goal) <= calibrated(f1);
predicate b = l2(z, goal) <= calibrated(conformal, alpha = 0.1);
monitor m = F (a && b);
END
cp "$SPECS/E0651_threshold_missing.thresholds.json" t.thresholds.json
"$ETLC" t.etl -o t.hpp
echo "exit status $?"
"$ETLC" t.etl --check
echo "exit status $?"
