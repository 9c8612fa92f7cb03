# Targets taken from a demonstration: unchanged, and normalised under cosine.
cat > hand.etl <<'END'
spec hand;
input z : f32[2];
target home = [[1, 0], [3, 4]];
predicate at_home = min l2(z, home)     <= calibrated(conformal, alpha = 0.5);
predicate faces   = min cosine(z, home) <= calibrated(conformal, alpha = 0.5);
truth at_home = z_x < 4;
truth faces   = z_x < 4;
input z_x : f32;
monitor returns = F at_home;
monitor turns   = F faces;
END
printf 'z[0],z[1],z_x\n3,3.5,3\n3,4,3\n' > a.csv
printf 'z[0],z[1],z_x\n3,3.5,3\n0.6,0.8,3\n' > b.csv
printf 'z[0],z[1],z_x\n3,3.5,3\n3,4.25,3\n' > c.csv
"$ETLC" calibrate hand.etl --data a.csv b.csv c.csv
echo "exit status $?"
ls
# If drives must begin at a target, a reason accepts it, and is shown beside the guarantees.
"$ETLC" calibrate hand.etl --data a.csv b.csv c.csv \
    --allow-overlap 'each drive begins at home' | sed -n '/^guarantees/,$p'
grep -A1 allowances hand.thresholds.json
"$ETLC" hand.etl --emit report | grep allow
