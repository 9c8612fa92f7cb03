#!/usr/bin/env bash
# outside_text_test.sh ETLC CXX: names of files, comments and strings of specs, thresholds files and
# data stay text in every output, whatever they contain. A header compiles and contains no planted
# code; JSON parses; a terminal gets no control or hidden characters and only UTF-8; make and ninja
# rebuild when a file of the depfile changes, or etlc refuses the name.
. "$(dirname "$0")/../box.bash"
etlc=$1
cxx=$2
failed=0
fail() { echo "FAILED: $*" >&2; failed=1; }

live=$'x\n#error INJECTED\nint injected;\n//'
hostile=(
    "$live"
    $'x\r#error INJECTED\rint injected;'
    'ends in a backslash\'
    'ends in a trigraph ??/'
    $'tab\tand  blanks and \'single\' and "double" quotes'
    'closes */ int injected; /* $(injected) ${injected} # : % ; & | > <'
    $'\e[31mred \e]0;title\a \b\x7f'
    $'not UTF-8 \xff\xfe \xc0\xaf \xed\xa0\x80'
    $'turns \u202e\u2066\u2069\u200f\u061c and hides \u200b\ufeff\u00ad\u0085\u009b31m'
    "$(printf 'long %.0s' {1..40})"
)

# Outputs are kept with their origin, and checked together at the end. keep KIND WHAT names the next
# file.
kept=0
mkdir text json code
keep() { out=$1/$((++kept)); printf '%s\n' "$2" >"$out.what"; }

# compiles HEADER WHAT
compiles() {
    cp "$1" plain.hpp
    printf '#include "plain.hpp"\nint main() { return sizeof(t::Inputs) == 0; }\n' >main.cpp
    "$cxx" -std=c++17 -Wall -Wextra -Wpedantic -Werror -fsyntax-only \
        -I "$runtime" main.cpp 2>log.txt ||
        { fail "$2: does not compile"; head -3 log.txt; }
}

spec_text() {
    printf 'spec t;\ninput x, y : f32;\ninput z : f32[2];\ntarget far = [[1, 2]];\npredicate %s' \
        'p = x < calibrated(conformal, alpha = 0.5);
truth p = y > 0;
predicate q = l2(z, far) <= 0.5;
'
    printf 'monitor m = G p && F[0, 3] q;\nmonitor unlabelled = F l2(z, far) < 0.25;\n'
}
thresholds() {  # METHOD ETLC SPEC TRUTH
    python3 - "$@" <<'END'
import json, os, sys
method, etlc, spec, truth = [os.fsencode(a).decode("utf-8", "replace") for a in sys.argv[1:5]]
entry = {"method": method, "alpha": 0.5, "epsilon": 1, "n": 3, "k": 2,
         "scores": [0.5, 0.99999997, 1.5],
         "reads": {"input x": "scalar[1]", "input y": "scalar[1]", "predicate p": "x <",
                   "predicate y > 0": "y > 0", "truth p": truth}}
episodes = ["%016x" % i for i in range(3)]
print(json.dumps({"format": 3, "spec": spec, "predicates": {"p": entry}, "monitors": {},
                  "episodes": episodes, "etlc": etlc}))
END
}

# header WHAT OF ARGUMENT...: makes a header, if etlc accepts the input; its code must equal that of
# the first header with the same OF.
header() {
    local what=$1 of=$2
    shift 2
    keep text "$what, messages"
    if "$etlc" "$@" -o made.hpp >"$out" 2>&1; then
        keep code "$what"
        echo "$of" >"$out.of"
        mv made.hpp "$out"
    fi
}

# briefly SPEC OF WHAT ARGUMENT...: the header, and the diagnostics as JSON.
briefly() {
    local spec=$1 of=$2 what=$3
    shift 3
    header "$what, robustness" "$of, robustness" "$spec" "$@"
    keep json "$what, diagnostics"
    "$etlc" "$spec" "$@" --check --diagnostics json 2>"$out" || true
}

# everything SPEC OF WHAT ARGUMENT...: every back end.
everything() {
    briefly "$@"
    local spec=$1 of=$2 what=$3
    shift 3
    header "$what, boolean" "$of, boolean" "$spec" "$@" --values boolean
    for stage in ast graph plan report dot; do
        keep text "$what, $stage"
        "$etlc" "$spec" "$@" --emit $stage -o - >"$out" 2>&1 || true
    done
}

spec_text >plain.etl
thresholds conformal 0.1.0 t 'y > 0' >plain.json
mkdir -p episodes
for e in 1 2 3; do printf 'x,y,z[0],z[1]\n0.5,1,1,2\n1.25,-1,0,%s\n' $e >episodes/$e.csv; done
python3 -c "
head = b\"{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }\".ljust(117) + b'\\n'
row = bytes([0, 0, 128, 62, 0, 0, 128, 63])
open('o.npy', 'wb').write(b'\\x93NUMPY\\x01\\x00' + bytes([118, 0]) + head + row)"
given=(--thresholds plain.json)
everything plain.etl plain "nothing hostile" "${given[@]}"
header "nothing hostile, standalone" standalone plain.etl "${given[@]}" --standalone
header "nothing hostile, stored" stored plain.etl "${given[@]}" --inline-targets 0
{ spec_text; printf 'monitor c = F (p && q);\n'; } >commented.etl
everything commented.etl commented "no comment" "${given[@]}"
{ spec_text; printf 'target o = load("o.npy");\nmonitor c = F l2(z, o) < 1;\n'; } >loads.etl
everything loads.etl loads "plain string" "${given[@]}"

for text in "${hostile[@]}"; do
    shown=$(printf '%q' "${text:0:40}")
    name=$(tr / _ <<<"${text:0:100}")  # of files
    mkdir -p "at $name"

    # The spec's file, and its folder; -o, --targets-file, --thresholds; missing files.
    cp plain.etl "at $name/$name.etl"
    cp plain.json "at $name/$name.json"
    everything "at $name/$name.etl" plain "spec called $shown" --thresholds "at $name/$name.json"
    header "spec called $shown, standalone" standalone "at $name/$name.etl" "${given[@]}" \
        --standalone
    "$etlc" "at $name/$name.etl" "${given[@]}" -o out.hpp
    compiles out.hpp "spec called $shown"
    header "targets called $shown" stored plain.etl "${given[@]}" --inline-targets 0 \
        --targets-file "at $name/$name"
    "$etlc" plain.etl "${given[@]}" --inline-targets 0 -o "at $name/$name.hpp"
    compiles "at $name/$name.hpp" "header called $shown"
    briefly plain.etl plain "no thresholds called $shown" --thresholds "no $name"
    header "no spec called $shown" none "no $name"
    header "option called $shown" none plain.etl "--$name"
    header "namespace called $shown" none plain.etl --namespace "$name"
    header "stage called $shown" none plain.etl --emit "$name"

    # Comments and strings of the spec: in a formula, after it, between declarations.
    oneline=${text//[$'\n\r']/ }
    closed=${oneline//\*\// }
    { spec_text; printf '// %s\nmonitor c = F /* %s */ (p // %s\n && q); /* %s */\n' "$oneline" \
        "$closed" \
        "$oneline" "$closed"; } >commented.etl
    everything commented.etl commented "comment $shown" "${given[@]}"
    string=${oneline//[\"\/]/_}
    cp o.npy "$string.npy" 2>/dev/null || true  # a name that is too long does not exist
    { spec_text; printf 'target o = load("%s.npy");\nmonitor c = F l2(z, o) < 1;\n' "$string"; } \
        >loads.etl
    everything loads.etl loads "string $shown" "${given[@]}"
    { spec_text; printf 'target o = load("no %s");\n%s' "$string" "$text"; } >loads.etl
    briefly loads.etl wrong "wrong string $shown" "${given[@]}"

    # The thresholds file.
    for field in 0 1 2 3; do
        words=(conformal 0.1.0 t 'y > 0')
        words[field]=$text
        thresholds "${words[@]}" >hostile.json
        briefly plain.etl plain "field $field of the thresholds $shown" --thresholds hostile.json
        keep text "field $field of the thresholds $shown, report"
        "$etlc" plain.etl --thresholds hostile.json --emit report -o - >"$out" 2>&1 || true
    done
    printf '{"format": 3, %s' "$text" >hostile.json
    header "thresholds $shown" none plain.etl --thresholds hostile.json

    # The data, its files, and everything else that a call names.
    cp episodes/1.csv "at $name/$name.csv"
    printf 'x,y,z[0],%s\n0.5,%s,1,2\n' "$text" "$text" >hostile.csv
    for trace in "at $name/$name.csv" "no $name" hostile.csv "no $name.h5:$name"; do
        keep text "run on $shown"
        "$etlc" run plain.etl "${given[@]}" --trace "$trace" >"$out" 2>&1 || true
        keep json "run on $shown"
        "$etlc" run plain.etl "${given[@]}" --trace "$trace" --diagnostics json 2>"$out" >out.csv ||
            true
    done
    keep text "map $shown"
    "$etlc" run plain.etl "${given[@]}" --trace episodes/1.csv --map "x=$text" >"$out" 2>&1 || true
    for data in episodes "at $name" "no $name" hostile.csv; do
        keep text "calibrate on $shown"
        "$etlc" calibrate "at $name/$name.etl" --data "$data" -o "$out.json" >"$out" 2>&1 || true
        keep text "evaluate on $shown"
        "$etlc" evaluate "at $name/$name.etl" "${given[@]}" --data "$data" --json "$out.json" \
            --csv out.csv \
            >"$out" 2>&1 && mv "$out.json" json/$kept && cp "$out.what" json/$kept.what
        keep json "evaluate on $shown"
        "$etlc" evaluate plain.etl "${given[@]}" --data "$data" --diagnostics json 2>"$out" \
            >out.csv || true
    done
    rm -rf "at $name"
done
[ -z "$(find . -name 'injected*')" ] || fail "a planted command ran"

python3 - <<'END' || failed=1
import glob, json, re, sys
hidden = re.compile("[\0-\t\v-\x1f\x7f-\x9f\xad\u061c\u200b-\u200f\u2028-\u202e"
                    "\u2060-\u206f\ufeff]")
problems, codes, looked = 0, {}, {"text": 0, "json": 0, "code": 0}
def fail(path, why):
    global problems
    problems += 1
    if problems < 20:
        print("FAILED:", open(path + ".what").read().strip() + ":", why, file=sys.stderr)
for path in sorted(glob.glob("*/*.what"), key=lambda p: int(p.split("/")[1][:-5])):
    path = path[:-5]
    kind = path.split("/")[0]
    try: content = open(path, "rb").read()
    except FileNotFoundError: continue
    looked[kind] += 1
    if kind == "json":
        try: content and json.loads(content)
        except ValueError as error: fail(path, f"no JSON: {error}")
        continue
    try: text = content.decode()
    except UnicodeDecodeError as error: fail(path, f"not UTF-8: {error}"); continue
    if kind == "text":  # an echoed line of the spec keeps its tabs
        text = "\n".join(l.replace("\t", " ") if re.match(" *[0-9]* \\| ", l) else l
                         for l in text.split("\n"))
    if found := hidden.search(text):
        before = text[max(0, found.start() - 40):found.end()]
        fail(path, f"hidden character {found[0]!r} in ...{before!r}")
    if kind == "code":
        if re.search(r"//.*(\\|[?][?]/)[ \t]*$", text, re.M):
            fail(path, "a comment that is continued")
        code = [l for l in (re.sub("//.*", "", l).rstrip() for l in text.split("\n"))
                if l and "kSpecHash" not in l and "inline namespace text_" not in l]
        # Both are digests that include the comments.
        if codes.setdefault(open(path + ".of").read(), code) != code: fail(path, "live text")
print(looked)
sys.exit(problems > 0 or min(looked.values()) < 80)
END

# Depfiles. Names that they can express, make and ninja follow; others are refused, and nothing is
# written.
rebuilds() {  # NAME: of the spec, of a file it loads, of the header
    local name=$1 loaded=${1//[$'\n\r']/}
    rm -rf built && mkdir built && cd built
    { spec_text; printf 'target o = load("%s.npy");\nmonitor c = F l2(z, o) < 1;\n' "$loaded"; } \
        >"$name.etl"
    cp ../o.npy "$loaded.npy"
    if ! "$etlc" "$name.etl" --thresholds ../plain.json -o "$name.hpp" \
        --depfile out.d 2>text.txt; then
        grep -q E0901 text.txt || fail "depfile with $name: $(cat text.txt)"
        [ ! -e "$name.hpp" ] && [ ! -e out.d ] ||
            fail "depfile with $name: refused, and something is written"
        cd .. && return 1
    fi
    # As in a build, the target is plain; the prerequisites are the hostile ones.
    printf '"%s" "$SPEC" --thresholds ../plain.json -o out.hpp --depfile out.d\n' "$etlc" >make.sh
    echo 'echo made >>log.txt' >>make.sh
    printf 'out.hpp:\n\tbash make.sh\n-include out.d\n' >Makefile
    printf 'rule etlc\n  command = bash make.sh\n  depfile = out.d\nbuild out.hpp: etlc\n' \
        >build.ninja
    export SPEC="$name.etl"
    for tool in make ninja; do
        rm -f out.hpp out.d log.txt .ninja_*
        for changed in "" "" "$name.etl" "" "$name.npy" ""; do
            [ -z "$changed" ] || { sleep 0.02; touch "$changed"; }
            $tool >text.txt 2>&1 || fail "$tool with $name: $(cat text.txt)"
        done
        [ "$(wc -l <log.txt)" = 3 ] || fail "$tool with $name: made $(wc -l <log.txt) times, not 3"
    done
    cd ..
}
for name in plain 'two  blanks' 'a#b' 'a$b' '$$(x)' 'a:b' '(1) x' 'é@{~}+,!'; do
    rebuilds "$name" || fail "depfile refuses $name"
done
for name in "$live" $'tab\tx' 'semi;colon' 'back\slash' 'star*' 'pipe|' 'quote'"'" 'a=b' 'a&b' \
    '~x' '[a]' 'a?' 'c%d'; do
    ! rebuilds "${name//\//_}" || fail "depfile names $name"
done
exit $failed
