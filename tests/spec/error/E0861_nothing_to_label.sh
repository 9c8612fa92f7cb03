# Labels of episodes, predicates and steps that do not exist.
. "$SPECS/../labels.bash"
calibrate_with 'episode,predicate,start,end' 'a,held,1,3' 'bb,held,1,3' 'c,held,,' 'c,held,,'
calibrate_with 'episode,predicate,start,end' 'a,hold,1,3' 'b,truth.held,1,3'
calibrate_with 'episode,predicate,start,end' 'a,held,1,5' 'b,held,4,'
calibrate_with 'episode,predicate,start,end' 'a,held,1,4' 'b,held,,' 'b,full,3,9'
rm labels.csv
mkdir again
cp a.csv again
printf 'episode,predicate\na,held\n' > both.csv
"$ETLC" calibrate hand.etl --data . again --labels both.csv
"$ETLC" calibrate hand.etl --data again --label-by folder
echo "exit status $?"
ls
