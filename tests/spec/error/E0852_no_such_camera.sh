# Two cameras without a choice, a camera that does not exist, and one for no input.
. "$SPECS/../dataset.bash"
"$ETLC" embed seen.etl --data set -o out
"$ETLC" embed seen.etl --data set -o out --camera front
"$ETLC" embed seen.etl --data set -o out --camera y=top
