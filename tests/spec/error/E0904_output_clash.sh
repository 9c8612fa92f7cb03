# No output may be a file that the call reads, under any name, nor another output; then nothing is
# written.
cat > dock.etl <<'END'
spec dock;
input z : f32[2];
target goal = load("goal.npy");
predicate near = l2(z, goal) <= 0.5;
monitor arrive = F near;
END
printf '\x93NUMPY\x01\x00\x46\x00%-69s\n' \
    "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }" > goal.npy
printf '\0\0\0\0\0\0\0\0' >> goal.npy
printf 'z[0],z[1],truth.near\n0,0,1\n1,1,0\n' > trace.csv
ln -s dock.etl link.etl
ln goal.npy same.npy
cp dock.etl kept.etl
clash() { "$ETLC" "$@"; echo "exit status $?"; }
clash dock.etl -o dock.etl
clash dock.etl -o ./link.etl
clash dock.etl -o dock.hpp --depfile same.npy
clash dock.etl -o dock.hpp --depfile ./dock.hpp
clash dock.etl -o dock.hpp --inline-targets 0 --targets-file goal.npy
clash run dock.etl --trace trace.csv -o trace.csv
clash evaluate dock.etl --data trace.csv --json dock.etl
clash evaluate dock.etl --data trace.csv --csv trace.csv
clash evaluate dock.etl --data trace.csv --csv both --json both
clash evaluate dock.etl --data trace.csv --csv - --json -
clash run dock.etl --trace trace.csv >> trace.csv
cmp dock.etl kept.etl
ls
