#!/usr/bin/env bash
# completion_test.sh ETLC: completion in bash offers every command and option that --help lists, and
# the values of options; the manual page has them too, and groff accepts it without warnings.
. "$(dirname "$0")/../box.bash"
etlc=$1

"$etlc" --help >help
mapfile -t commands < <(sed -n 's/^  etlc \([a-z]\+\)\( .*\)\?$/\1/p' help)
[ "${#commands[@]}" -ge 10 ] || fail "these are all commands? ${commands[*]}"

# names_in HELP: each name of each option, one per line.
names_in() {
    sed -n 's/^  \(-[^ ]*\).*/\1/p' "$1" | sed 's/{.*//' | tr ',' '\n' | LC_ALL=C sort
}
# choices_in HELP: "--values robustness boolean", one option per line.
choices_in() {
    sed -n 's/^  \(-[^ ]*\) [^ ]*:\([a-z0-9|][a-z0-9|]*\).*/\1 \2/p' "$1" |
        sed 's/{[^ ]*//; s/^-[^ ]*,//' | tr '|' ' '
}

"$etlc" --completion bash >etlc.bash
source ./etlc.bash
# completed WORD...: the words that bash would offer for the last one, one per line.
completed() {
    COMP_WORDS=(etlc "$@") COMP_CWORD=$#
    _etlc
    [ "${#COMPREPLY[@]}" = 0 ] || printf '%s\n' "${COMPREPLY[@]}" | LC_ALL=C sort
}
expect() {
    local expected=$1
    shift
    [ "$(completed "$@" | tr '\n' ' ')" = "$expected" ] ||
        fail "etlc $* <TAB> offers $(completed "$@" | tr '\n' ' '), expected $expected"
}
mkdir -p here/folder
cd here
touch a.etl b.csv 'with blank.etl'
expect "$(printf '%s\n' a.etl folder 'with blank.etl' "${commands[@]}" | LC_ALL=C sort |
    tr '\n' ' ')" ''
expect 'calibrate crossvalidate ' c
expect 'a.etl folder with blank.etl ' run ''
expect 'a.etl b.csv folder with blank.etl ' run a.etl --trace ''
expect 'b.csv ' run a.etl --trace b
expect 'folder ' embed a.etl -o ''
expect 'robustness ' run --values r
expect 'boolean ' run --values = b
expect 'boolean robustness ' run --values =
expect 'host portable ' a.etl --standalone =
expect 'a.etl folder with blank.etl ' a.etl --standalone ''
expect '' run --max-work ''
expect 'bash ' --completion ''
rm -r -- *

# ---- everything that --help lists
"$etlc" --man >etlc.1
groff -man -Tascii -P-cbou -rLL=200n -ww etlc.1 >page 2>warnings || fail "groff: $(cat warnings)"
[ ! -s warnings ] || fail "groff: $(cat warnings)"
section_of() { # its part of the page
    awk -v name="   etlc${1:+ }$1" '/^[A-Z]/ {on = (name == "   etlc" && $0 == "OPTIONS")}
        /^   [a-z]/ {on = $0 == name} on' page
}
checked=0
for command in '' "${commands[@]}"; do
    "$etlc" $command --help >"help.$command"
    { names_in "help.$command"; [ -n "$command" ] || printf '%s\n' --completion --man; } |
        LC_ALL=C sort >names
    diff names <(completed $command -) || fail "bash: < etlc $command --help lists, > is offered"
    section_of "$command" >section
    while read -r name; do
        grep -qE -- "^ +.*(^|[ ,])$name([ ,=[]|\$)" section || fail "the page: etlc $command $name"
        checked=$((checked + 1))
    done <names
    while read -r name words; do
        expect "$(tr ' ' '\n' <<<"$words" | LC_ALL=C sort | tr '\n' ' ')" $command "$name" = 
    done < <(choices_in "help.$command" | grep '^--')
done
[ "$checked" -gt 150 ] || fail "only $checked options were compared"

# ---- wrong calls
for call in '--completion tcsh' '--completion' '--man now'; do
    status=0
    "$etlc" $call >out 2>err || status=$?
    [ "$status" = 2 ] && [ ! -s out ] && [ -s err ] || fail "etlc $call: status $status"
done
