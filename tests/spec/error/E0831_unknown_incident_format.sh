# Files that are not incidents, and one of a later version.
cat > t.etl <<'END'
spec t;
input grip : f32;
monitor m = G grip > 0.5;
END
: > empty
printf '\211ETLINC\r\n and more of what was a text' > converted
printf '\211ETLINC\n\002\000\000\000\020\000\000\000' > later
for file in empty t.etl converted later; do "$ETLC" incident $file --spec t.etl; done
