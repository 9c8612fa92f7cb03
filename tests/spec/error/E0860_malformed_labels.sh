# Tables of labels that cannot be read.
. "$SPECS/../labels.bash"
calibrate_with 'episode,predicate,begin,end' 'a,held,1,3'
calibrate_with 'episode,start,end' 'a,1,3'
calibrate_with 'episode,predicate,start' 'a,held,1'
calibrate_with 'episode,predicate,start,end,start_s,end_s' 'a,held,1,3,,'
calibrate_with 'episode,predicate,end,start,end' 'a,held,1,3,3'
calibrate_with 'episode,predicate,start,end' 'a,held,0.5,3'
calibrate_with 'episode,predicate,start,end' 'a,held,-1,3'
calibrate_with 'episode,predicate,start_s,end_s' 'a,held,0.5s,3'
calibrate_with 'episode,predicate,start,end' 'a,held,3,1'
calibrate_with 'episode,predicate,start,end' 'a,held,1,1'
calibrate_with 'episode,predicate,start,end' ',held,1,3'
calibrate_with 'episode,predicate,start,end' 'a,?,1,3'
calibrate_with 'episode,predicate,start,end,group' 'a,,1,3,x'
: > labels.csv; "$ETLC" calibrate hand.etl --data .
sed -i '2i rate 10 Hz;' hand.etl
calibrate_with 'episode,predicate,start_s,end_s' 'a,held,0.13,0.17' 'b,held,0,0.4'
calibrate_with 'episode;predicate;start_s;end_s' 'a;held;0,1;0.3'
calibrate_with 'episode,predicate,start_s,end_s' 'a,held,0,1,0,3'
echo "exit status $?"
ls
