# A .json beside the model that contradicts the spec, has another key, or is not JSON.
. "$SPECS/../encoding.bash"
for settings in '{"image": [2, 2]}' '{"size": [2, 2]}' '{"mean": 0.5}' '[1]' '{'; do
    echo "$settings" > net.json
    embeds "$dimension$row$row$references"
done
