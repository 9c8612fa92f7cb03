# Labels that are unrelated to the distance, or inverted, and a threshold that one strange
# demonstration makes so wide that nearly every frame is within.
cat > t.etl <<'END'
spec t;
input x, y, wide : f32;
target origin = [[0]];
predicate chance  = l2([x], origin) <= calibrated(f1);
predicate turned  = x >= calibrated(conformal, alpha = 0.2);
predicate strange = l2([wide], origin) <= calibrated(conformal, alpha = 0.1);
predicate sound   = l2([y], origin) < calibrated(conformal, alpha = 0.1);
monitor m = F (chance && turned && strange && sound);
END
for episode in 1 2 3 4 5 6 7 8 9; do
    printf 'x,y,wide,truth.chance,truth.turned,truth.strange,truth.sound\n'
    for frame in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
        x=$(((frame * 7 + episode * 3) % 20 + 1))
        near=$((frame % 2))
        far=$((frame == 1 && episode == 5 ? 30 : frame))
        echo "$x,$frame,$far,$near,$((x < 8)),$((frame < 8)),$((frame < 8))"
    done
done | awk '/^x/ { file = "e" ++n ".csv" } { print > file }'
"$ETLC" calibrate t.etl --data .
echo "exit status $?"
"$ETLC" calibrate t.etl --data . -Werror > report.txt 2>&1
echo "exit status $?"
