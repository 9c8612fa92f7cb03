# Metadata of version 3.0 that are not Parquet.
. "$SPECS/../dataset.bash"
sed -i 's/v2.1/v3.0/' set/meta/info.json
mkdir -p set/meta/episodes/chunk-000
echo '{}' > set/meta/episodes/chunk-000/file-000.parquet
"$ETLC" run rows.etl --trace set --map push=action[0]
