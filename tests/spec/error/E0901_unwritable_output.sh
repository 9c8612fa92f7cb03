# An output that cannot be written, without remains.
printf 'spec t;\ninput ok : bool;\nmonitor m = G ok;\n' > t.etl
"$ETLC" t.etl -o nowhere/t.hpp
echo "exit status $?"
mkdir folder
"$ETLC" t.etl -o folder
echo "exit status $?"
ls folder
