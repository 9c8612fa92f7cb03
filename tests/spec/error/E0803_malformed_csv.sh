# Quotes, line ends, row lengths; no rows of verdicts remain.
. "$SPECS/../trace.bash"
row() { printf "z[0],z[1],grip,held\n$1" > trace.csv; "$ETLC" run t.etl --trace trace.csv \
    -o verdicts.csv; }
row '1,2,0.5,1\n1,2,0.5\n'
row '1,2,0.5,1,0\n'
row '1,"2,0.5,1\n'
row '1,"2"x,0.5,1\n'
row '1,2",0.5,1\n'
row '1,2,0.5,1\r1,2,0.5,1\r'
: > trace.csv; "$ETLC" run t.etl --trace trace.csv
printf '\377\376z\000x' > trace.csv; "$ETLC" run t.etl --trace trace.csv
{ echo 'z[0],z[1],grip,held'; head -c 5000000 /dev/zero |
    tr '\0' ','; } > trace.csv; "$ETLC" run t.etl --trace trace.csv
ls
