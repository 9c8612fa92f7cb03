# A file that is not text.
printf 'spec a;\n\000\001' > binary.etl
"$ETLC" binary.etl --check
