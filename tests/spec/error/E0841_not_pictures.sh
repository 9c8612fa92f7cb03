# Files that are not pictures, and arrays without pictures.
cat > t.etl <<'SPEC'
spec t;
input grip : f32;
monitor m = G grip > 0.5;
SPEC
printf 'grip\n1\n0\n' > a.csv
printf 'GIF89a' | tee 1.png > 2.png
"$ETLC" report t.etl --data a.csv --frames '*.png' -o page.html
"$ETLC" report t.etl --data a.csv --frames camera -o page.html
