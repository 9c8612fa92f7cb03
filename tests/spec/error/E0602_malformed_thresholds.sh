# Thresholds files that are no JSON, or a bomb of brackets.
cat > t.etl <<'END'
spec t;
input z : f32[1];
target goal = [[1]];
predicate near = l2(z, goal) <= calibrated(f1);
monitor m = F near;
END
printf '{\n  "format": 3,\n  "spec": "t",\n  predicates: {}\n}\n' > words.json
printf '{"format": 3, "spec": "t"' > short.json
printf '{"format": 3, "spec": "t", "predicates": 1e999}' > large_number.json
head -c 1000000 /dev/zero | tr '\0' '[' > bomb.json
for file in words short large_number bomb; do "$ETLC" t.etl --check --thresholds $file.json; done
