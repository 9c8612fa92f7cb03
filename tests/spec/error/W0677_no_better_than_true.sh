# A threshold that includes every frame, one that separates, and a predicate whose truth comes
# after the same number of steps in every episode. With few episodes the question stays open, and
# a careful monitor gets no warning.
cat > dock.etl <<'END2'
spec dock;
input x : f32;
target goal = [[0]];
predicate docked = l2([x], goal) <= 100;
predicate near   = l2([x], goal) <= 4;
predicate late   = l2([x], goal) <= 6;
monitor arrives = F docked;
monitor nears   = F near;
monitor is_late = F late;
END2
for i in 1 2 3 4 5 6; do
    printf 'x,truth.docked,truth.near,truth.late\n'
    for row in 1 2 3 4 5 6 7 8 9; do
        step=$((12 - row - 2 * (i % 3)))
        echo "$((step < 0 ? 0 : step)).5,$((step < 4)),$((step < 4)),$((row > 4))"
    done
done | awk '/^x/ { file = "e" ++n ".csv" } { print > file }'
"$ETLC" evaluate dock.etl --data . > report.txt
echo "exit status $?"
"$ETLC" evaluate dock.etl --data e1.csv e2.csv e3.csv > report.txt
echo "exit status $?"
"$ETLC" evaluate dock.etl --data . -Werror > report.txt 2>&1
echo "exit status $?"
