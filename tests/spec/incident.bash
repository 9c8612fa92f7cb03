# Shared by cases of incidents: the spec and the thresholds of E0832_held.incident. Source it in an
# empty folder.
cat > gripper.etl <<'END'
spec gripper;
rate 10 Hz;
input z : f32[2];
input force : f32;
target wall = load("wall.npy");
predicate at_wall = l2(z, wall) <= 0.5;
predicate light = force <= calibrated(conformal, alpha = 0.5);
monitor safe = G (at_wall -> light);
END
cp "$SPECS/E0409_plain.npy" wall.npy
thresholds() { cat > gripper.thresholds.json <<END
{"format": 3, "spec": "gripper", "predicates": {"light": {"method": "conformal", "alpha": 0.5,
 "epsilon": $1, "n": 1, "k": 1, "scores": [$2], "reads": {"input force": "scalar[1]",
 "predicate light": "force <=", "rate": "0.1 s a step", "truth light": "an array or table"}}},
 "monitors": {}, "episodes": ["0123456789abcdef"], "etlc": "0.2.0"}
END
}
thresholds 3 2.9999998
