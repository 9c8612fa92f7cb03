# Metadata that are damaged, or have another version.
. "$SPECS/../dataset.bash"
sed -i 's/v2.1/v1.6/' set/meta/info.json
"$ETLC" run rows.etl --trace set --map push=action[0]
echo '{' > set/meta/info.json
"$ETLC" run rows.etl --trace set --map push=action[0]
