# Two cameras and none named, one that is not there, and one for no input.
. "$SPECS/../dataset.bash"
"$ETLC" embed seen.etl --data set -o out
"$ETLC" embed seen.etl --data set -o out --camera front
"$ETLC" embed seen.etl --data set -o out --camera y=top
