# The second image is damaged; another one has an unknown format; there is none.
. "$SPECS/../encoding.bash"
decodes 65 "has 16 bits a channel, expected 8: save it with 8"
sed -i 's/for file; do/for file in "$1"; do/' embedder
embeds "$dimension$row$row$references"
echo > bay/a.tiff
for path in bay/a.tiff nothing/ 'bay/*.jpg'; do
    sed "s|bay/\*.png|$path|" t.etl > u.etl
    "$ETLC" embed u.etl --encoder-cmd cat
done
rm -f frames # of the first encoder, which may not have got so far
ls
