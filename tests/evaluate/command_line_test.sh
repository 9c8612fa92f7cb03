#!/usr/bin/env bash
# command_line_test.sh ETLC FOLDER DATA: `etlc evaluate` from end to end: table, CSV and JSON are
# equal for any number of threads; episodes in an .h5 file; wrong calls; folds; two specs.
. "$(dirname "$0")/../box.bash"
etlc=$1 expected=$2 data=$3

cat >dock.etl <<'SPEC'
spec dock;
rate 10 Hz;
input z  : f32[2];
input px : f32;
target goal = [[1, 1]];
predicate near = l2(z, goal) <= 0.5;
truth near = px > 0;
monitor arrive = F near;
monitor twice = F (near && F (px < 0));
SPEC
mkdir episodes
for e in 0 1 2 3 4 5; do
    awk -v e=$e 'BEGIN {
        print "px,z[0],z[1]"
        for (t = 0; t < 12; ++t) {
            px = (t * (e + 3)) % 7 - 3.5
            z = px > 0 || (t + e) % 5 == 0 ? 1.25 : 3
            print px "," z ",1"
        }
    }' >episodes/$e.csv
done

for jobs in 1 4; do
    "$etlc" evaluate dock.etl --data episodes -j $jobs --json $jobs.json --csv $jobs.csv >$jobs.txt
    "$etlc" evaluate dock.etl --data 'episodes/*.csv' -j $jobs --json - >alone.json
    cmp $jobs.json alone.json
done
cmp 1.txt 4.txt && cmp 1.csv 4.csv && cmp 1.json 4.json
for form in txt json; do
    if [ "${ETLC_UPDATE:-}" = 1 ]; then cp 1.$form "$expected/dock.expected.$form"; fi
    diff -u "$expected/dock.expected.$form" 1.$form
done
# The table has the figures of the JSON.
python3 - <<'END'
import csv, json
def flat(value, *path):
    if not isinstance(value, dict):
        return {"_".join(path): value}
    return {k: v for name, inner in value.items() for k, v in flat(inner, *path, name).items()}
rows, figures = list(csv.DictReader(open("1.csv"))), flat(json.load(open("1.json")))
assert len(rows) == 143 and len({(*row.values(),) for row in rows}) == 143
for row in rows:
    level = "" if row["level"] == "frames" else row["level"] + "_"
    if row["figure"].startswith(("turns", "delay")):
        level = "detection_"
    figure = row["figure"].replace("delay_", "").replace("turns_", "")
    key = f"{row['kind']}s_{row['name']}_{level}{figure}"
    assert (float(row["value"]) if row["value"] else None) == figures[key], row
    interval = [row["low"], row["high"]]
    assert interval == ["", ""] or list(map(float, interval)) == figures[key + "_interval"], row
END

cat >groups.etl <<'SPEC'
spec groups;
input z : f32[3];
target origin = [[0, 0, 0]];
predicate at_a = l2(z, origin) > 3.5;
monitor m = F at_a;
SPEC
"$etlc" evaluate groups.etl --data "$data/trace.h5" --episodes 'data/demo_*[0-9]' --map z=obs/z \
    >groups.txt
grep -q '^3 episodes, 21 frames' groups.txt || fail "$(cat groups.txt)"

sed 's/<= 0.5;/<= calibrated(adaptive, alpha = 0.5, gamma = 0.1, lo = 0, hi = 4);/' dock.etl \
    >adaptive.etl
"$etlc" calibrate adaptive.etl --data episodes/[012].csv >calibrated.txt
"$etlc" evaluate adaptive.etl --data episodes/[345].csv >adaptive.txt
grep -q '^near: evaluated with its initial threshold, which labels would adapt$' adaptive.txt ||
    fail "$(cat adaptive.txt)"

status=0
"$etlc" evaluate dock.etl 2>err.txt || status=$?
[ $status = 2 ] && grep -q -- --data err.txt || fail "no --data: $status, $(cat err.txt)"

# Undefined figures are null but present: here a monitor misses every turn.
sed 's/<= 0.5;/<= 0;/' dock.etl >blind.etl
"$etlc" evaluate blind.etl --data episodes --json blind.json >blind.txt
grep -q '"mean_seconds": null' blind.json || fail "mean_seconds: $(grep -A8 detection blind.json)"

# Each episode is in one fold. Order and names of files and the number of threads do not matter, and
# a second spec does not change the result of the first.
sed 's/<= 0.5;/<= calibrated(conformal, alpha = 0.4);/' dock.etl >folded.etl
sed 's/target goal = .*/target goal = [[3, 2]];/' folded.etl >other.etl
"$etlc" crossvalidate folded.etl --data episodes --folds 3 --json folds.json --by-episode \
    --csv rows.csv >folds.txt
cp -r episodes renamed
for e in 0 1 2 3 4 5; do mv renamed/$e.csv renamed/by_$((9 - e)).csv; done
"$etlc" evaluate folded.etl --data renamed --folds 3 -j 4 --by-episode --csv renamed.csv >/dev/null
for e in 0 1 2 3 4 5; do echo "renamed/by_$((9 - e)).csv episodes/$e.csv"; done >names
while read -r new old; do sed -i "s|^$new,|$old,|" renamed.csv; done <names
diff <(sort rows.csv) <(sort renamed.csv)
python3 - <<'END'
import csv, json
folds = json.load(open("folds.json"))
rows = folds["by_episode"]
assert [fold["episodes"] for fold in folds["folds"]] == [2, 2, 2]
assert sorted(row["episode"] for row in rows) == [f"episodes/{e}.csv" for e in range(6)]
assert sorted(row["fold"] for row in rows) == [1, 1, 2, 2, 3, 3]
shares = [(len(row["wrong_verdicts"]), 1 - row["agreement"]) for row in rows]
assert shares == sorted(shares, reverse=True) and shares[0] > shares[-1], shares
frames = folds["predicates"]["near"]
assert frames["positives"] + frames["negatives"] == sum(row["frames"] for row in rows) == 72
table = list(csv.DictReader(open("rows.csv")))
assert [row["episode"] for row in table] == [row["episode"] for row in rows]
assert [float(row["near_f1"]) for row in table] == [row["predicates"]["near"]["f1"] for row in rows]
END
# Variants change nothing else: no threshold, no fold, no other figure. Bad kinds are refused.
"$etlc" crossvalidate folded.etl --data episodes --folds 3 --json varied.json --by-episode \
    --variants cut,frozen,reversed >varied.txt
python3 - <<'END'
import json
plain, varied = json.load(open("folds.json")), json.load(open("varied.json"))
kinds = varied.pop("variants")
assert list(kinds) == ["cut", "frozen", "reversed"]
assert kinds["reversed"] == {"made": 6, "without": 0}, kinds
for name, monitor in varied["monitors"].items():
    own = monitor.pop("variants")
    assert list(own) == ["cut", "frozen", "reversed", "all"]
    counts = [own[kind]["positives"] + own[kind]["negatives"] for kind in own]
    assert counts[:3] == [kinds[kind]["made"] for kind in kinds] and sum(counts[:3]) == counts[3]
    assert "duration" not in own["all"]
assert plain == varied
END
for kinds in cut,cat '' cut, cut,cut; do
    status=0
    "$etlc" evaluate dock.etl --data episodes --variants "$kinds" 2>err.txt >/dev/null || status=$?
    [ $status = 2 ] && grep -q -- --variants err.txt || fail "'$kinds': $status, $(cat err.txt)"
done
# The counts equal those of a separate calibration and evaluation for each fold.
python3 - "$etlc" <<'END'
import json, subprocess, sys
def etlc(*words):
    done = subprocess.run([sys.argv[1], *words], stdout=subprocess.PIPE, check=True)
    return done.stdout
folds = json.load(open("folds.json"))
rows = folds["by_episode"]
figures = lambda found: (found["predicates"]["near"], found["monitors"]["arrive"]["episodes"],
                         found["monitors"]["twice"]["steps"])
counts = ("true_positives", "false_positives", "false_negatives", "true_negatives")
sums = [dict.fromkeys(counts, 0) for _ in range(3)]
for fold in (1, 2, 3):
    others = [row["episode"] for row in rows if row["fold"] != fold]
    held_out = [row["episode"] for row in rows if row["fold"] == fold]
    etlc("calibrate", "folded.etl", "-o", "t.json", "--data", *others)
    found = json.loads(etlc("evaluate", "folded.etl", "--thresholds", "t.json", "--json", "-",
                            "--data", *held_out))
    for total, score in zip(sums, figures(found)):
        for count in counts:
            total[count] += score[count]
assert sums == [{count: score[count] for count in counts} for score in figures(folds)], sums
END
"$etlc" crossvalidate other.etl folded.etl --data episodes --folds 3 --json both.json \
    --csv both.csv >both.txt 2>both.err
grep -q '^folded.etl less other.etl ' both.txt || fail "$(cat both.txt)"
[ "$(grep -c W0671 both.err)" = 1 ] || fail "a warning of every fold: $(cat both.err)"
python3 - <<'END'
import csv, json
both, alone = json.load(open("both.json")), json.load(open("folds.json"))
other, folded = both["specs"]["other.etl"], both["specs"]["folded.etl"]
del alone["by_episode"]
assert folded == alone
found = {(d.get("predicate") or d.get("monitor"), d["level"]): d for d in both["differences"]}
assert set(found) == {("near", "frames"), ("arrive", "steps"), ("arrive", "episodes"),
                      ("twice", "steps"), ("twice", "episodes")}
for (name, level), d in found.items():
    of = [s["predicates"][name] if level == "frames" else s["monitors"][name][level]
          for s in (folded, other)]
    for figure in ("f1", "precision", "recall", "agreement"):
        if d[figure] is not None:
            assert abs(d[figure] - (of[0][figure] - of[1][figure])) < 1e-12, (name, level, figure)
assert found["near", "frames"]["f1"] != 0
rows = [row for row in csv.DictReader(open("both.csv")) if row["less"]]
assert {row["spec"] for row in rows} == {"folded.etl"}
assert [float(row["value"]) for row in rows if row["figure"] == "auroc"] == [
    found["near", "frames"]["auroc"]]
END

# Monitors that are calibrated as a whole get episodes that the predicates have not seen.
sed 's/alpha = 0.4/alpha = 0.5/
    s/F near;/F near calibrated(conformal, alpha = 0.5, against = missed_alarm);/' folded.etl \
    >whole.etl
"$etlc" crossvalidate whole.etl --data episodes --folds 3 >whole.txt
grep -q '^fold  episodes held out  near of the others  arrive of the others$' whole.txt ||
    fail "$(cat whole.txt)"
"$etlc" crossvalidate whole.etl --data renamed --folds 3 | head -6 | diff <(head -6 whole.txt) -

# Against both errors a fold has two thresholds. One that takes more episodes is infinite.
sed 's/alpha = 0.4/alpha = 0.5, beta = 0.01, against = both/' folded.etl >both.etl
"$etlc" crossvalidate both.etl --data episodes --folds 3 --json both.json 2>/dev/null
python3 - <<'END' || fail "the thresholds of a fold"
import json
for fold in json.load(open("both.json"))["folds"]:
    assert set(fold["thresholds"]) == {"near", "near, inner"}, fold
    assert fold["thresholds"]["near"] > 0 and fold["thresholds"]["near, inner"] == "-inf", fold
END

# Every fold has its own fit, on episodes of the others that its calibration does not see.
sed 's/^target goal = .*/projection along = fitted(discriminant, r = 1, of = z, where = near);\
target goal = fitted(mean, of = along(z), where = near);/
    s/l2(z, goal)/l2(along(z), goal)/; s/alpha = 0.4/alpha = 0.5/' folded.etl >fitted.etl
"$etlc" crossvalidate fitted.etl --data episodes --folds 3 >fitted.txt 2>fitted.err
grep -q '^near .* 1.000 \[' fitted.txt || fail "$(cat fitted.txt)"
[ ! -e fitted.fitted.npz ] || fail "a fold has written a file"

# Without each fold: the thresholds equal those of separate commands.
"$etlc" calibrate folded.etl --data episodes --folds 6 -o folded.json >folds.txt
for e in 0 1 2 3 4 5; do
    mkdir without$e
    cp episodes/*.csv without$e && rm without$e/$e.csv
    "$etlc" calibrate folded.etl --data without$e -o - 2>/dev/null |
        python3 -c 'import json, sys
print(json.load(sys.stdin)["predicates"]["near"]["epsilon"])'
done | sort -g >thresholds
grep -q "^    near: $(head -1 thresholds) to $(tail -1 thresholds); held out, 5 of 5 " \
    folds.txt || fail "$(cat folds.txt thresholds)"

# Between two thresholds a prediction is unknown: no error, and no error's denominator shrinks.
cat >between.etl <<'SPEC'
spec between;
input x : f32;
predicate p = x <= calibrated(conformal, alpha = 0.2, against = both);
monitor done = F p;
SPEC
mkdir shown new
for e in 0 1 2 3 4; do
    printf 'x,truth.p\n2,0\n0.%s,1\n1.2,1\n0.9,0\n' $e >shown/$e.csv
done
for e in 0 1 2 3 4; do
    printf 'x,truth.p\n2,0\n1.0%s,1\n1.1,0\n0.5,0\n0.6,1\n2,0\n3,1\n' $e >new/$e.csv
done
"$etlc" calibrate between.etl --data shown 2>/dev/null >between.txt
"$etlc" evaluate between.etl --data new --json between.json >between.txt 2>between.err
python3 - <<'END'
import json
of = json.load(open("between.json"))
p, done = of["predicates"]["p"], of["monitors"]["done"]
counts = [p[f"{name}_{of}"] for of in ("positives", "negatives")
          for name in ("true", "false", "unknown")]
assert counts == [5, 5, 5, 10, 5, 5], counts
assert (p["unknown"], p["wrong_when_decided"]) == (10 / 35, 10 / 25), p
assert (p["false_negative_rate"], p["false_positive_rate"]) == (5 / 15, 5 / 20), p
assert (p["coverage"], p["coverage_of_negatives"], p["unmeasured"]) == (0, 0, 0), p
# F p is unknown from step 1 on, where it is true, and satisfied at step 3.
assert (done["steps"]["unknown_positives"], done["steps"]["coverage"]) == (10, 1), done
assert done["episodes"]["true_positives"] == 5, done
END
grep -q '^unknown, which agrees with nothing ' between.txt || fail "$(cat between.txt)"
