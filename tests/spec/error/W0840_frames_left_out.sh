# Episodes without pictures, or with too few, are shown without any.
cat > t.etl <<'SPEC'
spec t;
input grip : f32;
monitor m = G grip > 0.5;
SPEC
for episode in a b c; do
    printf 'grip\n1\n0\n' > $episode.csv
    mkdir $episode
    printf '\x89PNG' > $episode/1.png
done
printf '\x89PNG' > a/2.png
rm b/1.png
"$ETLC" report t.etl --data a.csv b.csv c.csv --frames '{episode}/*.png' -o page.html
grep -c 'data:image/png;base64,iVBORw==' page.html
