# Shared by cases of labels: a spec, and two episodes of four steps without labels. Source it in an
# empty folder.
cat > hand.etl <<'END'
spec hand;
input grip : f32;
predicate held = grip >= calibrated(conformal, alpha = 0.5);
predicate full = grip >= 2;
monitor holds = F held && G !full;
END
printf 'grip\n0\n0.5\n1\n3\n' > a.csv
printf 'grip\n0\n0.75\n1.5\n2.5\n' > b.csv
# Calibrates with these rows as labels.csv.
calibrate_with() {
    printf '%s\n' "$@" > labels.csv
    "$ETLC" calibrate hand.etl --data .
}
