# With --check, missing thresholds and a missing target are not errors; everything else is.
cat > t.etl <<'END'
spec t;
input z : f32[1];
target goal = [[1]];
predicate a = l2(z, goal) <= calibrated(f1);
predicate b = l2(z, goal) <= calibrated(conformal, alpha = 0.1);
monitor m = F (a && b) calibrated(conformal, alpha = 0.1, against = missed_success);
END
"$ETLC" t.etl -o t.hpp
echo "exit status $?"
"$ETLC" t.etl --check -Werror
echo "exit status $?"
"$ETLC" t.etl --check --thresholds later.json --diagnostics json
echo "exit status $?"
sed -i 's/\[\[1\]\]/load("goal.npy")/; s/F (a/F (c || a/' t.etl
"$ETLC" t.etl --check
echo 'predicate c = min l1(z, goal) <= 0.5;' >> t.etl
"$ETLC" t.etl --check
echo "exit status $?"
"$ETLC" t.etl -o t.hpp
mkdir goal.npy
"$ETLC" t.etl --check
# A key that its file does not have yet.
cp "$SPECS/E0408_two.npz" two.npz
sed 's/load("goal.npy")/load("two.npz", "goal_c")/' t.etl > u.etl
"$ETLC" u.etl --check
echo "exit status $?"
"$ETLC" u.etl -o u.hpp
