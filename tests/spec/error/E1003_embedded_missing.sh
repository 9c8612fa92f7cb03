# Nothing is embedded yet; not by this encoder; not of these images.
. "$SPECS/../encoding.bash"
"$ETLC" t.etl -o m.hpp
"$ETLC" t.etl --check
embeds "$dimension$row$row$references" > /dev/null
sed -i 's/images("bay\/\*.png")/images("bay\/1.png")/' t.etl
"$ETLC" t.etl -o m.hpp
sed -i 's/ net/ other/' t.etl
"$ETLC" t.etl -o m.hpp
