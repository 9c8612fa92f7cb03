#!/usr/bin/env bash
# options_test.sh ETLC: the values that options accept and refuse; which commands report the
# warnings of a spec.
. "$(dirname "$0")/../box.bash"
etlc=$1

cat >t.etl <<'END'
spec t;
input x, unused : f32;
monitor m = F x > 0.5;
END
printf 'x\n1\n' >t.csv

# refuses MESSAGE ARGUMENT...: exits with status 2 and prints MESSAGE after the name of the option.
refuses() {
    local status=0
    "$etlc" "${@:2}" >out.txt 2>err.txt || status=$?
    [ "$status" = 2 ] || fail "${*:2}: exit status $status"
    head -1 err.txt | grep -qxF "etlc: $1" || fail "${*:2}: $(head -1 err.txt)"
}
refuses "--values: found 'bool', expected robustness or boolean" t.etl --check --values bool
refuses "--values: found 'bolean', expected robustness or boolean; did you mean 'boolean'?" \
    t.etl --check --values bolean
refuses "--values: found '0', expected robustness or boolean" t.etl --check --values 0
refuses "--targets-as: found 'f8', expected f32, f16 or i8; did you mean 'i8'?" \
    run t.etl --trace t.csv --targets-as f8
expected="ast, graph, plan, hpp, params, dot or report"
refuses "--emit: found 'hp', expected $expected; did you mean 'hpp'?" \
    t.etl --emit hp
refuses "--onnxruntime excludes --encoder-cmd" embed t.etl --onnxruntime a.so --encoder-cmd cat
refuses "--pipe encodes frames of standard input, and writes no files" embed t.etl --pipe net \
    --data a --output b
refuses "--diagnostics: found 'xml', expected text or json" t.etl --check --diagnostics xml
refuses "-W: found 'all', expected error" t.etl --check -Wall
# A word that is empty is not skipped, and its option does not take the next word.
refuses "the word behind '--data' is empty: is a variable of the shell not set?" \
    evaluate t.etl --data '' --jobs 1
refuses "the word behind '--thresholds' is empty: is a variable of the shell not set?" \
    run t.etl --trace t.csv --thresholds=
refuses "the word behind 'etlc' is empty: is a variable of the shell not set?" '' --check
# A misspelt command is not taken for a spec.
refuses "there is no command 'rn'; did you mean 'run'?" rn t.etl --trace t.csv
refuses "there is no command 'rn'; did you mean 'run'?" rn
refuses "there is no command 'help'; did you mean '--help'?" help
refuses "there is no command 'evalute'; did you mean 'evaluate'?" evalute t.etl --data t.csv
refuses "there is no command 'simulate'; the commands are run, embed, fit, calibrate, evaluate, \
crossvalidate, lsp, merge, explain, incident, report, label, watch, prove, dossier, annotate; \
etlc SPEC.etl compiles a spec" \
    simulate t.etl
for option in --max-state --max-code --max-work --inline-targets; do
    for number in -1 1e3 0x10 ' 8' 1.5 99999999999999999999 ten; do
        refuses "$option: found '$number', expected a whole number from 0" \
            t.etl --check "$option=$number"
    done
    "$etlc" t.etl --check "$option" 1000000 2>err.txt || fail "$option 1000000: $(cat err.txt)"
done
for number in 0 -1 1025 all; do
    refuses "--jobs: found '$number', expected a whole number from 1 to 1024" \
        evaluate t.etl --data t.csv "--jobs=$number"
done
refuses "--format: found 'xml', expected text or json" explain t.etl --trace t.csv --format xml
for time in -1 nan 1s ' 1'; do
    refuses "--at: found '$time', expected a number of seconds from 0" \
        explain t.etl --trace t.csv "--at=$time"
done
for recorder in 2s 2s,1s 2s,1s,0 2s,1s,-1 2s,1s,4,1 1.5,1,4 -1,1,4 2h,1,4 inf,1,4 ,1,4 1,1,ten; do
    refuses "--recorder: found '$recorder', expected BEFORE,AFTER,INCIDENTS: two durations or \
numbers of steps, and how many incidents, as 2s,1s,4 or 40,20,4" \
        t.etl --check "--recorder=$recorder"
done
for recorder in 0,0,1 4,2,3; do
    "$etlc" t.etl --check --recorder $recorder 2>err.txt || fail "--recorder $recorder"
done
refuses "--format: found 'json', expected table, csv, trace or spec" \
    incident t.csv --spec t.etl --format json
refuses "--explain follows robustness to the sample that it comes from, and --values boolean has \
no robustness: leave out one of the two" t.etl -o - --explain --values boolean
"$etlc" t.etl --values boolean -o boolean.hpp 2>err.txt || fail "$(cat err.txt)"
"$etlc" t.etl --values robustness -o robustness.hpp 2>err.txt || fail "$(cat err.txt)"
! cmp -s boolean.hpp robustness.hpp || fail "--values makes no difference"
"$etlc" t.etl -o usual.hpp 2>err.txt && cmp usual.hpp robustness.hpp

# A class with --explain names rows only if 2^22 steps can still be counted: not those of the larger
# set.
rows() { seq -s ', ' 1 "$1" | sed 's/[0-9][0-9]*/[&]/g'; }
for sizes in '120 133 named' '120 134 left'; do
    read -r small large names <<<"$sizes"
    printf '%s\n' 'spec rows;' 'input z : f32[1];' "target few = [$(rows "$small")];" \
        "target many = [$(rows "$large")];" \
        'monitor m = G (min l2(z, few) > 1 || min l1(z, many) > 1);' >rows.etl
    "$etlc" rows.etl --explain -o rows.hpp 2>err.txt || fail "$(cat err.txt)"
    grep -q "1.0f, 0, $small}" rows.hpp || fail "$small rows are not named"
    named=left
    if grep -q "1.0f, $((small + 1)), $large}" rows.hpp; then named=named; fi
    [ $named = "$names" ] || fail "the rows of $large and $small are $named"
done

# Commands that compile a spec report its warnings.
"$etlc" t.etl --check 2>err.txt
grep -q W0201 err.txt || fail "--check does not warn"
"$etlc" run t.etl --trace t.csv >out.txt 2>err.txt
[ ! -s err.txt ] || fail "run repeats the warnings of the spec: $(cat err.txt)"
if "$etlc" run t.etl --trace t.csv -Werror >out.txt 2>err.txt; then fail "run -Werror"; fi
grep -q W0201 err.txt || fail "run -Werror does not say why"
