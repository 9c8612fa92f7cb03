# --lets if lets have no value at their own step: one is omitted, all are an error.
cat >some.etl <<'END'
spec some;
input x : f32;
let low = x <= 1;
let soon = F[0, 3] low;
monitor m = G soon;
END
"$ETLC" some.etl --lets --check && echo "the others are there"
cat >all.etl <<'END'
spec all;
input x : f32;
let soon = F[0, 3] x <= 1;
let late = G soon;
monitor m = late;
END
"$ETLC" all.etl --lets --check
cat >none.etl <<'END'
spec none;
input x : f32;
monitor m = F x > 1;
END
"$ETLC" none.etl --lets --check
printf 'x\n1\n' >x.csv
"$ETLC" run none.etl --lets --trace x.csv
