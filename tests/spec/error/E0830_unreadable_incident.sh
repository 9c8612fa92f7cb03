# A missing incident, and a folder.
cat > t.etl <<'END'
spec t;
input grip : f32;
monitor m = G grip > 0.5;
END
mkdir folder
for file in no_such folder; do "$ETLC" incident $file --spec t.etl; done
