# Two inputs by one encoder need two cameras; a video is one.
. "$SPECS/../encoding.bash"
sed -i 's/input z/input y, z/; s/l2(z, bay) <= 1/l2(z, bay) <= l2(y, bay) + 1/' t.etl
sed -i 's/<= l2(y, bay) + 1/<= 1 \&\& min l2(y, bay) <= 1/' t.etl
echo > ep.mp4
embeds "$dimension$row$row$references" --data ep.mp4 -o out
ls out
