# Missing pictures, and a pattern that is the same for every episode.
cat > t.etl <<'SPEC'
spec t;
input grip : f32;
monitor m = G grip > 0.5;
SPEC
printf 'grip\n1\n0\n' | tee a.csv > b.csv
mkdir pictures
"$ETLC" report t.etl --data a.csv b.csv --frames 'pictures/*.png' -o page.html
"$ETLC" report t.etl --data a.csv b.csv --frames 'pictures/{episode}/*.png' -o page.html
ls
