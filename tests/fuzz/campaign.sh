#!/bin/sh
# campaign.sh SECONDS [TARGET...]: fuzzes every target, or the named ones, for SECONDS each and
# stops at the first finding. Run it in a build folder of the preset `sanitized`; it keeps new
# inputs in its tests/fuzz/found for the next time.
set -eu
seconds=${1:?usage: campaign.sh SECONDS [TARGET...]}
shift
here=$(cd "$(dirname "$0")" && pwd)
if ! [ -d tests/fuzz ]; then
  echo "campaign.sh: no tests/fuzz here: run it in a build folder of the preset sanitized" >&2
  exit 2
fi
[ $# -gt 0 ] || set -- $(ls "$here/corpus")
for target in "$@"; do
  echo "$target: $seconds s"
  mkdir -p "tests/fuzz/found/$target"
  "tests/fuzz/$target" -max_total_time="$seconds" -timeout=60 -rss_limit_mb=2048 \
    -print_final_stats=1 -verbosity=0 -print_funcs=0 \
    -artifact_prefix="tests/fuzz/$target-" "tests/fuzz/found/$target" "$here/corpus/$target"
done
echo "no findings"
