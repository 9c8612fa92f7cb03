# Commands that crash, hang, write too little, too much, or something else.
. "$SPECS/../encoding.bash"
"$ETLC" embed t.etl --encoder-cmd 'echo "no module named torch" >&2; exit 3'
"$ETLC" embed t.etl --encoder-cmd 'kill -9 $$'
"$ETLC" embed t.etl --encoder-cmd 'sleep 60' --encoder-timeout 1
embeds ""
embeds "$dimension$row"
embeds "$dimension$row$row$row$references"
embeds "\\000\\000\\000\\000"
"$ETLC" embed t.etl --encoder-cmd "cat > frames; printf '$dimension$row$row$references'; exit 4"
ls
