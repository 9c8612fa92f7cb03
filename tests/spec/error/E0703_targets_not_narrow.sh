# --targets-as with an element beyond float16, and with no distance that can be narrow.
cat >beyond.etl <<'END'
spec beyond;
input z : f32[2];
target a = [[1.5, 2.5], [0.5, 70000]];
predicate near = min l2(z, a) <= 1;
monitor m = F near;
END
"$ETLC" beyond.etl --targets-as f16 --check
"$ETLC" beyond.etl --targets-as i8 --check && echo "i8: fine"
cat >expression.etl <<'END'
spec expression;
input z : f32[2];
target a = [[1.5, 2.5]];
target b = [[0.5, 3]];
predicate contrast = 2 * l2(z, a) - l2(z, b) <= 0.1;
predicate within = mahalanobis([[2, 0.5], [0.5, 1]])(z, a) <= 1;
monitor m = F (contrast && within);
END
"$ETLC" expression.etl --targets-as f16 --check
cat >stored.etl <<'END'
spec stored;
input z : f32[2];
target a = [[1.5, 2.5], [0.5, 3]];
predicate near = min l2(z, a) <= 1;
monitor m = F near;
END
"$ETLC" stored.etl --targets-as i8 --inline-targets 0 -o stored.hpp
"$ETLC" stored.etl --targets-as i8 --inline-targets 16 -o stored.hpp
cat >none.etl <<'END'
spec none;
input x : f32;
monitor m = F x > 1;
END
"$ETLC" none.etl --targets-as i8 --check
