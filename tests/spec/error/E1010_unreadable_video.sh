# A video that is cut, one that crashes its reader, a missing one: nothing is written.
. "$SPECS/../encoding.bash"
echo > ep.mp4
decodes 65 "promises 100 frames and holds 57: it is cut or damaged"
sed -i 's/^video).*/video) ;;/; s/^images)/images) trap "exit 0" EXIT;/' embedder
embeds_each --data ep.mp4 -o out
sed -i 's/^video).*/video) kill -SEGV $$ ;;/' embedder
embeds_each --data ep.mp4 -o out
embeds_each --data no.mp4 'no*.mp4' out -o out
ls . out
