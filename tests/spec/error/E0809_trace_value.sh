# 300 is not an int8.
cat > hand.etl <<'END'
spec hand;
input z : i8[2] scale 0.5;
target home = [[0, 0]];
predicate at_home = l2(z, home) <= 1;
monitor returns = F at_home;
END
printf 'z[0],z[1]\n1,2\n3,300\n' > hand.csv
"$ETLC" run hand.etl --trace hand.csv -o verdicts.csv
echo "exit status $?"
ls
