# A shift whose monitor now counts missing samples differently; a threshold whose labels were
# arrays.
cat > t.etl <<'END'
spec t;
input x, y : f32;
predicate near = x <= 0.5 missing false;
truth near = y < 1;
monitor stays = G[0, 1] near calibrated(conformal, alpha = 0.4, against = missed_success);
END
for e in 1 2 3; do printf 'x,y\n0.%d,0\n0.3,0\n' $e > $e.csv; done
"$ETLC" calibrate t.etl --data [1-3].csv > report.txt 2>&1
"$ETLC" t.etl --check && echo believed
sed -i 's/missing false/missing true/' t.etl
"$ETLC" t.etl --check
sed -i "s/ missing true/ missing false/; s/monitor stays/sliding monitor stays/" t.etl
"$ETLC" t.etl --check

cat > a.etl <<'END'
spec a;
input x, y : f32;
predicate near = x <= calibrated(conformal, alpha = 0.4);
monitor reaches = F near;
END
for e in 4 5 6; do printf 'x,y,truth.near\n0.%d,0,1\n0.3,1,0\n' $e > $e.csv; done
"$ETLC" calibrate a.etl --data [4-6].csv > report.txt 2>&1
"$ETLC" a.etl --check && echo believed
sed -i 's/^monitor/truth near = y > 0.5; monitor/' a.etl
"$ETLC" a.etl --check
