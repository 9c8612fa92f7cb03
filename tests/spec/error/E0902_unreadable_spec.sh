# A missing spec, and a folder.
"$ETLC" missing.etl --check
echo "exit status $?"
mkdir folder.etl
"$ETLC" folder.etl --check
echo "exit status $?"
"$ETLC" run missing.etl --trace t.csv
echo "exit status $?"
