# A threshold that includes every frame, beside one that separates. With few episodes the question
# stays open, and a careful monitor gets no warning.
cat > dock.etl <<'END2'
spec dock;
input x : f32;
target goal = [[0]];
predicate docked = l2([x], goal) <= 100;
predicate near   = l2([x], goal) <= 4;
monitor arrives = F docked;
monitor nears   = F near;
END2
for i in 1 2 3 4 5 6; do
    printf 'x,truth.docked,truth.near\n'
    for step in 9 8 7 6 5 4 3 2 1; do
        echo "$((step + i % 2)).5,$((step < 4)),$((step < 4))"
    done
done | awk '/^x/ { file = "e" ++n ".csv" } { print > file }'
"$ETLC" evaluate dock.etl --data . > report.txt
echo "exit status $?"
"$ETLC" evaluate dock.etl --data e1.csv e2.csv e3.csv > report.txt
echo "exit status $?"
"$ETLC" evaluate dock.etl --data . -Werror > report.txt 2>&1
echo "exit status $?"
