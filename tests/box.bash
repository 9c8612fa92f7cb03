# Sourced by tests in bash: an empty folder as the current one, which is deleted at the end.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
runtime=$here/../../runtime/include
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT
cd "$box"
fail() { echo "FAILED: $*" >&2; exit 1; }
