#!/usr/bin/env bash
# symbols_test.sh LIBRARY HEADER PAGE: the library has exactly the documented functions, each with
# its documented version; the header declares all of them, and the page has an example of each.
set -euo pipefail
library=$1 header=$2 page=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

found=$(nm --dynamic --defined-only --with-symbol-versions "$library" | awk '$2 == "T" {print $3}' |
    sed 's/@@/ /' | LC_ALL=C sort)
diff "$here/symbols.txt" <(echo "$found") || {
    echo "FAILED: functions of the library; < was promised, > is there"
    exit 1
}
declared=$(grep -oP '^ETLC_EXPORT .*?\K\betlc_[a-z_]+(?=\()' "$header" | LC_ALL=C sort)
diff <(cut -d' ' -f1 "$here/symbols.txt") <(echo "$declared") || {
    echo "FAILED: functions of the header; < was promised, > is declared"
    exit 1
}
others=$(nm --dynamic --defined-only "$library" | awk '$2 != "A" {print $3}' | grep -v '^etlc_' ||
    true)
[ -z "$others" ] || { echo "FAILED: the library shows more than its functions: $others"; exit 1; }
examples=$(awk '/^```c$/ {on = 1; next} /^```/ {on = 0} on' "$page")
for name in $(cut -d' ' -f1 "$here/symbols.txt"); do
    grep -q "\b$name(" <<<"$examples" || { echo "FAILED: $page has no example of $name"; exit 1; }
done
