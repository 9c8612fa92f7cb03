# Every input that the monitors use needs its columns, or its array, exactly once.
. "$SPECS/../trace.bash"
header() { echo "$1" > trace.csv; "$ETLC" run t.etl --trace trace.csv; }
header 'z[0],z[1],gripp,held'
header 'z[0],grip,held'
header 'z0,z1,grip,held'
header 'z[0],z[1],grip,held,grip'
"$ETLC" run t.etl --trace "$SPECS/E0804_absent.npz" 2>&1 | sed "s|$SPECS/||"
# The name in --map must be an input of the spec; its value is looked up in the file.
printf 'z[0],z[1],grip,closed\n1,2,0.75,0\n' > trace.csv
"$ETLC" run t.etl --trace trace.csv --map held=closed --map gripper=grip
"$ETLC" run t.etl --trace trace.csv --map held=closed --map grip=gripp
"$ETLC" run t.etl --trace trace.csv --map held=closed
