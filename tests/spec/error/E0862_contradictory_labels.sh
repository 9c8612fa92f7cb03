# Labels that overlap, each with both places.
. "$SPECS/../labels.bash"
calibrate_with 'episode,predicate,start,end' 'a,held,1,3' 'b,held,,' 'a.csv,?held,2,4'
calibrate_with 'episode,predicate,start,end' 'a,held,1,3' 'a,held,1,3' 'b,!held,,' 'b,held,1,2'
calibrate_with 'episode,predicate,group' 'a,held,x' 'b,held,x' 'a,full,y'
printf 'episode,predicate\na,held\nb,held\n' > one.csv
printf 'episode,predicate,start,end\nb,!held,2,3\n' > two.csv
"$ETLC" calibrate hand.etl --data . --labels one.csv two.csv
mkdir held
printf 'grip,truth.held\n0,0\n1,1\n' > held/c.csv
printf 'episode,predicate\nc,held\n' > held/labels.csv
"$ETLC" calibrate hand.etl --data held
rm held/labels.csv
"$ETLC" calibrate hand.etl --data held --label-by folder
printf 'grip\n0\n1\n' > held/c.csv
printf 'episode,predicate\nc,held\n' > held/labels.csv
"$ETLC" calibrate hand.etl --data held --label-by folder
echo "exit status $?"
ls
