# Files that unpack to more memory than available: the message names the file. A sanitizer reserves
# the address space, so no limit can be set, and the test is skipped.
cat > big.etl <<'END'
spec big;
input z : f32[1000];
target goal = load("big.npy");
monitor m = F min l2(z, goal) <= 0.5;
END
printf '\x93NUMPY\x01\x00\x46\x00%-69s\n' \
    "{'descr': '|i1', 'fortran_order': False, 'shape': (50000, 1000), }" > big.npy
truncate -s 50000080 big.npy
limited() { (ulimit -v 300000 && exec "$ETLC" "$@"); }
if limited --version > version 2>&1; then
    limited big.etl --check
    echo "exit status $?"
else
    printf '%s\n' "big.npy: error: there is not enough memory to read it [E0905]" \
        "big.etl:3:15: note: named here" "    3 | target goal = load(\"big.npy\");" \
        "      |               ^~~~~~~~~~~~~~~" "1 error" "exit status 1"
fi
