#!/usr/bin/env bash
# wheel_test.sh BUILD_DIR CMAKE TEST PYTHON: makes the wheel, installs it with pip with nothing of
# this build in the path, and runs TEST, the test of the package. The wheel contains everything it
# loads except Python and the C library.
set -euo pipefail
build_dir=$1 cmake=$2 test=$3 python=$4
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT

fail() { echo "FAILED: $*"; exit 1; }

"$cmake" --build "$build_dir" --target wheel >"$box/log" 2>&1 ||
    { cat "$box/log"; fail "the wheel is not made"; }
"$python" -m venv --system-site-packages "$box/venv"
"$box/venv/bin/pip" install --quiet --no-index --no-deps "$build_dir"/dist/etlc-*.whl
cd "$box"
unset ETLC_LIBRARY ETLC_COMMAND PYTHONPATH LD_LIBRARY_PATH
export PATH=$box/venv/bin:/usr/bin:/bin
python3 "$test" "$(dirname "$test")/../spec" >"$box/log" 2>&1 ||
    { cat "$box/log"; fail "the tests of the package"; }
native=$(python3 -c 'import etlc; print(etlc._library.NATIVE)')
[[ $native == "$box/venv/"* ]] || fail "another etlc is imported: $native"
programs=(lib/libetlc.so.1 bin/etlc libexec/etlc/etlc-{read-hdf5,read-parquet,embed})
[ ! -e "$build_dir/etlc-serve" ] || programs+=(libexec/etlc/etlc-serve)
for program in "${programs[@]}"; do
    others=$(ldd "$native/$program" | awk '$2 == "=>" {print $3}' | grep -v "^$native/" |
        grep -vE '/(lib(c|m|gcc_s|stdc\+\+|resolv))\.so[.0-9]*$' || true)
    [ -z "$others" ] || fail "$program loads from outside of the wheel: $others"
done

# The command is in the path, and is a module of Python; both pass on words and status.
expected=$("$native/bin/etlc" --version)
for command in etlc "python3 -m etlc"; do
    [ "$($command --version)" = "$expected" ] || fail "$command --version: $($command --version)"
    status=0
    $command --check "no such.etl" 2>said || status=$?
    [ "$status" -eq 1 ] && grep -q "no such.etl" said || fail "$command: $status, $(cat said)"
done
[ "$(command -v etlc)" = "$box/venv/bin/etlc" ] || fail "etlc is $(command -v etlc)"

# Another program of the wheel reads an .h5 trace.
data=$(cd "$(dirname "$test")" && pwd)/../unit/data
cat >t.etl <<'SPEC'
spec t;
input gripper : f32;
monitor m = F (gripper > 0.5);
SPEC
etlc run t.etl --trace "$data/trace.h5" | tail -1 | grep -qx \
    "6,m,0.25,0.25,inf,satisfied,1,0" || fail "the verdicts on an .h5 trace"

# It decodes images and runs networks, and says what decodes video.
"$native/libexec/etlc/etlc-embed" video any.mp4 2>said && fail "the wheel decodes video"
grep -q "etlc-embed-video, which decodes video, cannot be run: .* package etlc-embed" said ||
    fail "who decodes video: $(cat said)"

# It serves the page of labels.
[ -e "$native/libexec/etlc/etlc-serve" ] || exit 0
printf 'spec t;\ninput gripper : f32;\npredicate closed = gripper > 0.5;\nmonitor m = F closed;\n' \
    >labelled.etl
printf 'gripper\n0\n1\n' >episode.csv
etlc label labelled.etl --data episode.csv >page 2>&1 &
server=$!
trap 'kill $server; rm -rf "$box"' EXIT
for ((turn = 0; turn < 300; ++turn)); do
    ! grep -q 'http://' page || break
    sleep 0.1
done
python3 - "$(grep -oE 'http://[^ ]+' page | head -n 1)" <<'END' || fail "the page: $(cat page)"
import sys
from urllib.request import urlopen
assert b"<html" in urlopen(sys.argv[1]).read(), "no page"
END
