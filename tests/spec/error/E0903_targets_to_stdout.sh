# A target set that is too large for a header on standard output, unless it has its own file.
printf 'spec t;\ninput z : f32[3];\ntarget near = [[1, 2, 3], [4, 5, 6]];\n' > t.etl
printf 'predicate at = min l2(z, near) <= 1;\nmonitor m = F at;\n' >> t.etl
"$ETLC" t.etl -o - --inline-targets 23
echo "exit status $?"
"$ETLC" t.etl -o - --inline-targets 24 > inlined.hpp
echo "exit status $?"
"$ETLC" t.etl -o - --inline-targets 23 --targets-file t.bin > stored.hpp
echo "exit status $?; $(wc -c < t.bin) bytes"
"$ETLC" t.etl -o t.hpp --inline-targets 23
cmp t.targets.bin t.bin && echo "the same bytes beside t.hpp"
mkdir t2.targets.bin
"$ETLC" t.etl -o t2.hpp --inline-targets 23
ls
# A check writes nothing and needs no file, whatever the sizes.
printf "\\x93NUMPY\\x01\\x00\\x76\\x00%-117s\\n" \
    "{'descr': '<f4', 'fortran_order': False, 'shape': (70000, 1), }" > large.npy
head -c 280000 /dev/zero >> large.npy
sed 's/f32\[3\]/f32[1]/; s/\[\[.*\]\]/load("large.npy")/' t.etl > large.etl
"$ETLC" large.etl --check
echo "exit status $?"
