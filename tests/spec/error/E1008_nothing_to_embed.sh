# A spec without an encoder, and recordings for no input.
. "$SPECS/../encoding.bash"
sed -i 's/ by net;/;/; s/images(.*)/[[1, 2]]/' t.etl
"$ETLC" embed t.etl --data bay -o out
sed -i '/^encoder/d' t.etl
"$ETLC" embed t.etl
