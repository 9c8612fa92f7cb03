# An adaptive threshold moves by itself, so no class made with --retargetable has one.
cp "$SPECS"/../ok/adaptive.etl "$SPECS"/../ok/adaptive.thresholds.json .
"$ETLC" adaptive.etl --retargetable -o adaptive.hpp
ls
