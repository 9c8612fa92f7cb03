# Two strange demonstrations make a threshold so wide that the monitor is satisfied from the start.
# The other monitor is seldom wrong, but often a frame too early, which broken variants show.
cat > t.etl <<'END'
spec t;
input wide, sound : f32;
target origin = [[0]];
predicate there   = l2([wide], origin) <= calibrated(conformal, alpha = 0.1);
predicate arrived = l2([sound], origin) <= calibrated(conformal, alpha = 0.1);
monitor arrives = F there;
monitor sees    = F arrived;
END
for episode in 1 2 3 4 5 6 7 8 9 10 11 12; do
    printf 'wide,sound,truth.there,truth.arrived\n'
    for frame in 1 2 3 4 5 6 7 8 9 10; do
        distance=$((20 - 2 * frame + (episode * 7 + frame * 3) % 5))
        wide=$(((episode == 4 || episode == 9) && frame == 10 ? 30 : distance))
        echo "$wide.$((episode + 10)),$distance.$((episode + 10)),$((frame > 8)),$((frame > 8))"
    done
done | awk '/^w/ { file = "e" ++n ".csv" } { print > file }'
"$ETLC" calibrate t.etl --data .
echo "exit status $?"
