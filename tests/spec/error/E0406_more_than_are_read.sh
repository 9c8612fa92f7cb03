# A file that is as large as its header says, and larger than any target set may be: 128 MiB and one
# byte of int8. The header is padded to 128 bytes by hand; the data are a hole in the file.
header="{'descr': '|i1', 'fortran_order': False, 'shape': (134217729, 1), }"
{ printf '\223NUMPY\001\000v\000%-117s\n' "$header"; } > large.npy
truncate -s $((128 + 134217729)) large.npy
cat > t.etl <<'END'
spec t;
input z : f32[1];
target large = load("large.npy");
monitor m = F min l2(z, large) <= 1;
END
"$ETLC" t.etl --check
