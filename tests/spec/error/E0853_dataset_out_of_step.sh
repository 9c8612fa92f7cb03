# A spec with another rate than the rows.
. "$SPECS/../dataset.bash"
sed -i 's/10 Hz/5 Hz/' rows.etl
"$ETLC" run rows.etl --trace set --map push=action[0]
sed -i 's/5 Hz/4 Hz/' rows.etl
"$ETLC" run rows.etl --trace set --map push=action[0]
