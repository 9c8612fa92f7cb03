#!/usr/bin/env bash
# paper_example_test.sh PROGRAM EXPECTED: the program prints the paper's numbers. ETLC_UPDATE=1
# rewrites EXPECTED.
set -euo pipefail
program=$1 expected=$2
if [ "${ETLC_UPDATE:-}" = 1 ]; then "$program" >"$expected"; fi
diff -u "$expected" <("$program")
# The paper's own figures, independent of EXPECTED.
for figures in '0.327 .* 0.082 .* satisfied' '0.374 .* 0.035 .* satisfied' \
    '0.403 .* 0.006 .* satisfied' '0.427 .* -0.018 .* violated'; do
    grep -q -- "$figures" "$expected" || { echo "missing: $figures"; exit 1; }
done
