# One fault at a time: a missing, unknown or repeated key; values of another type or out of range.
cat > t.etl <<'END'
spec t;
input z : f32[1];
target goal = [[1]];
predicate near = l2(z, goal) <= calibrated(f1);
monitor m = F near;
END
fault() { sed "$1" "$SPECS/E0604_invalid_thresholds.thresholds.json" |
    sed 's/1e39/0.5/' > fault.json; "$ETLC" t.etl --check --thresholds fault.json; }
fault '/"spec"/d'
fault 's/"epsilon"/"epsilom"/'
fault 's/"epsilon".*/"epsilon": 1, "epsilon": 2,/'
fault 's/1e39/"0.5"/'
fault 's/"n": 100/"n": -1/'
fault 's/"k": 0/"k": 1/'
fault 's/"f1"/"fl"/'
fault 's/"method": "f1"/"method": "f1", "alpha": 0.1/'
fault 's/\[0.5\],$/[true],/'
fault 's/"reads": {.*/"reads": {"target goal": 1}/'
fault 's/"reads"/"targets"/'
fault 's/"near": {/"near": 1, "other": {/'
