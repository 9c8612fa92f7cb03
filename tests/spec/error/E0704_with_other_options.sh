# A monitor that is calibrated as a whole; and options that cannot be combined with --retargetable.
cat >whole.etl <<'SPEC'
spec whole;
input x : f32 in [0, 4];
predicate low = x <= 1;
truth low = x < 1;
monitor m = F low calibrated(conformal, alpha = 0.5, against = missed_alarm);
SPEC
for x in 0.5 0.75 1; do printf 'x\n%s\n' $x >$x.csv; done
"$ETLC" calibrate whole.etl --data 0.5.csv 0.75.csv 1.csv >report.txt 2>&1
"$ETLC" whole.etl --retargetable -o whole.hpp
cat >plain.etl <<'SPEC'
spec plain;
input x : f32;
monitor m = F x > 1;
SPEC
for option in "--values boolean" --explain "--recorder 1,1,1" "--targets-as f16" \
    "--inline-targets 4" "--targets-file t.bin"; do
    "$ETLC" plain.etl --retargetable -o plain.hpp $option
    echo "exit status $?"
done
"$ETLC" plain.etl --emit params --values boolean -o plain.params.bin
"$ETLC" run plain.etl --retargetable --values boolean --trace none.csv
"$ETLC" plain.etl --retargetable -o - >stdout.hpp
"$ETLC" plain.etl --emit params -o plain.params.bin && wc -c <plain.params.bin
# All files of a call or none.
mkdir busy.params.bin
"$ETLC" plain.etl --retargetable -o busy.hpp
ls
