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
for program in lib/libetlc.so.1 bin/etlc libexec/etlc/etlc-{read-hdf5,read-parquet,embed}; do
    others=$(ldd "$native/$program" | awk '$2 == "=>" {print $3}' | grep -v "^$native/" |
        grep -vE '/(lib(c|m|gcc_s|stdc\+\+|resolv))\.so[.0-9]*$' || true)
    [ -z "$others" ] || fail "$program loads from outside of the wheel: $others"
done

# Another program of the wheel reads an .h5 trace.
data=$(cd "$(dirname "$test")" && pwd)/../unit/data
cat >t.etl <<'SPEC'
spec t;
input gripper : f32;
monitor m = F (gripper > 0.5);
SPEC
"$native/bin/etlc" run t.etl --trace "$data/trace.h5" | tail -1 | grep -qx \
    "6,m,0.25,0.25,inf,satisfied,1,0" || fail "the verdicts on an .h5 trace"

# It decodes images and runs networks, and says what decodes video.
"$native/libexec/etlc/etlc-embed" video any.mp4 2>said && fail "the wheel decodes video"
grep -q "etlc-embed-video, which decodes video, cannot be run: .* package etlc-embed" said ||
    fail "who decodes video: $(cat said)"

# It says what serves the page of labels.
"$native/bin/etlc" label t.etl --data "$data/trace.h5" 2>said && fail "the wheel serves a page"
grep -q "etlc-serve cannot be run, .* of the packages of etlc, etlc-serve has it" said ||
    fail "who serves pages: $(cat said)"
