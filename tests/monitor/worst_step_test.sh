#!/usr/bin/env bash
# worst_step_test.sh ETLC CXX: the work, the state and the stack of the worst step are as stated by
# the class. callgrind counts the instructions of the steps of one class per kind of stream and
# reading, wide windows among them; none takes more than a fixed number plus a fixed number per
# operation of kOperations. docs/generated_code.md states these numbers.
set -euo pipefail
etlc=$1
cxx=$2
per_operation=${PER_OPERATION:-8}
fixed=${FIXED:-120} # reading two inputs, two predicates, the verdict
frame=512           # stack in addition to kStackBytes: saved registers, intermediate results
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT
cd "$box"

# NAME STEPS FORMULA; a sliding monitor if the name begins with s_.
cat >formulas <<'END'
latch 3500 p && O[0, 3] q
fold 3500 F p
fold_window 3500 p U[3, 90] q
connectives 3500 F p && G q || F (p && q)
delays 3500 G (O[30, 30] p || q)
once_window 3500 G (q || O[0, 64] p)
since_window 3500 G (q S[0, 65] p)
since_ever 3500 G (q S p)
s_until 3500 p U[2, 80] q
s_release 3500 p R[0, 33] q
s_nested 3500 F[0, 20] (p && G[0, 30] q)
response 3500 G (p -> F[0, 50] q)
response_late 3500 G (p -> F[7, 50] q)
chain 3500 F (p && F (q && F (p && q)))
unrolled 3500 G (p -> X (q U p))
unrolled_windows 3500 F (p && G[0, 9] (q || X p))
table 3500 G (p -> F[0, 40] G q)
table_until 3500 G (p U[2, 6] (q && F[0, 8] p))
pending 3500 G (p -> F[0, 30] (q && F[0, 25] p))
pending_until 3500 G[0, 39] (p U[4, 30] (q && G[2, 9] p))
pending_machine 3500 G (p -> F[0, 60] (q U[2, inf] p)) || G (q -> F[3, 70] (p R q))
f_100000 3500 F[0, 100000] p
s_f_100000 200020 F[0, 100000] p
always_f_100000 200020 G F[0, 100000] p
u_10000 3500 p U[0, 10000] q
s_u_10000 100020 p U[0, 10000] q
always_u_10000 100020 G (p U[0, 10000] q)
nested_1000 3500 G[0, 1000] (p -> F[0, 100] q)
s_nested_1000 3500 G[0, 1000] (p -> F[0, 100] q)
always_nested_1000 3500 G G[0, 1000] (p -> F[0, 100] q)
END

runs=
while read -r name steps formula; do
    sliding=
    [[ $name != s_* ]] || sliding=sliding
    {
        printf 'spec %s;\ninput x, y : f32 in [-4, 4];\n' "$name"
        printf 'predicate p = x >= 0.5;\npredicate q = y < 0.25;\n'
        printf '%s monitor m = %s;\n' "$sliding" "$formula"
    } >"$name.etl"
    "$etlc" "$name.etl" -o "$name.hpp" 2>"$name.log" || { cat "$name.log"; exit 1; }
    echo "#include \"$name.hpp\"" >>main.cpp
    runs+="  worst_step::run<$name::Monitor, $name::Inputs>(\"$name\", $steps);"$'\n'
done <formulas
printf '#include "worst_step.hpp"\nint main() {\n%s}\n' "$runs" >>main.cpp
"$cxx" -std=c++17 -O2 -fstack-usage -I. -I"$here/driver" -I"$here/../../runtime/include" main.cpp \
    -o main
valgrind --tool=callgrind --combine-dumps=yes --callgrind-out-file=counts ./main \
    >states 2>valgrind.log || { cat valgrind.log; exit 1; }

# The class is in inline namespaces named after the flags and after the text of its header.
class='([A-Za-z0-9_]+)::[A-Za-z0-9_]+::text_[0-9a-f]+::Monitor'
sed -nE "s/.*with Monitor = $class.*\t([0-9]+)\t.*/\1 \2/p
    s/.* $class::[a-z_]+\(.*\t([0-9]+)\t.*/\1 \2/p" ./*.su >frames
awk -v frame="$frame" '
NR == FNR { stated[$1] = $7; next }
{ taken[$1] += $2 }
END {
    for (name in taken) {
        ++classes
        if (taken[name] <= stated[name] + frame) continue
        print "FAILED: " name " takes " taken[name] " bytes of stack, " stated[name] " stated"
        bad = 1
    }
    exit bad || classes != '"$(wc -l <formulas)"'
}' states frames

awk '$3 != $5 { print "FAILED: " $0; bad = 1 } END { exit bad }' states
awk -v per="$per_operation" -v fixed="$fixed" '
/^desc: Trigger: Client Request: / { name = $5; operations = $6 }
/^(summary|totals): / && name != "" {
    if ($2 > worst[name]) worst[name] = $2
    stated[name] = operations
    name = ""
}
END {
    for (name in worst) {
        ++classes
        line = sprintf("%-18s %9d operations stated, worst step %9d instructions", name,
            stated[name], worst[name])
        good = worst[name] <= fixed + per * stated[name]
        print (good ? "" : "FAILED: ") line
        bad = bad || !good
    }
    print classes " classes"
    exit bad || classes != '"$(wc -l <formulas)"'
}' counts
