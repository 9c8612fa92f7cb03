# Cells that are not numbers, with their place.
. "$SPECS/../trace.bash"
row() { printf "note,z[0],z[1],grip,held\n,1,2,0.5,1\n$1\n" > trace.csv; "$ETLC" run t.etl \
    --trace trace.csv -o verdicts.csv; }
row '"two\nlines",1,two,0.5,1'
row ',1,2,"0,5",1'
row ',1,2,0x10,1'
row ',1,2,0.5,yes'
row ',1,2,True,1'
row ',1,2,0.5,0.5'
row ',1,2,0.5\033[31m,1'
ls
