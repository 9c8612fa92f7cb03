#!/usr/bin/env bash
# deb_test.sh BUILD_DIR CPACK VERSION: makes the Debian package, and looks into it.
set -euo pipefail
build_dir=$1 cpack=$2 version=$3
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT

fail() { echo "FAILED: $*"; exit 1; }

(cd "$build_dir" && "$cpack" -G DEB -B "$box") >"$box/log" 2>&1 || { cat "$box/log"; fail "cpack"; }
deb=$(echo "$box"/etlc_"$version"_*.deb)
[ -f "$deb" ] || { ls "$box"; fail "there is no package of version $version"; }

depends=$(dpkg-deb -f "$deb" Depends)
for library in libc6 libstdc++6 libfmt9 libhdf5-103 libzip4; do
    [[ $depends == *"$library"* ]] || fail "it does not depend on $library: $depends"
done
dpkg-deb -x "$deb" "$box/root"
[[ $("$box/root/usr/bin/etlc" --version) == *"$version"* ]] ||
    fail "etlc --version does not say $version"
for file in include/etlmon/temporal/value.hpp share/cmake/etlc/etlcConfig.cmake \
    share/cmake/etlc/EtlAddMonitor.cmake share/doc/etlc/copyright include/etlc.h \
    lib/libetlc.so lib/libetlc.so.1 lib/pkgconfig/etlc.pc share/man/man1/etlc.1 \
    share/bash-completion/completions/etlc share/zsh/vendor-completions/_etlc \
    share/fish/vendor_completions.d/etlc.fish; do
    [ -f "$box/root/usr/$file" ] || fail "it lacks /usr/$file"
done

# HDF5 files are read by a program beside etlc's folder, wherever the package is unpacked.
cat >"$box/t.etl" <<'SPEC'
spec t;
input gripper : f32;
monitor m = F (gripper > 0.5);
SPEC
data=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/../unit/data
verdicts=$("$box/root/usr/bin/etlc" run "$box/t.etl" --trace "$data/trace.h5") ||
    fail "an .h5 trace cannot be read: $verdicts"
[ "$(tail -1 <<<"$verdicts")" = "6,m,0.25,0.25,inf,satisfied,1,0" ] ||
    fail "the verdicts on an .h5 trace: $verdicts"

# Python finds the package, and the package the library.
said=$(LD_LIBRARY_PATH=$box/root/usr/lib PATH=$box/root/usr/bin:$PATH \
    PYTHONPATH=$box/root/usr/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1 \
    /usr/bin/python3 -c 'import etlc, sys
print(etlc.__version__, etlc.Monitor(sys.argv[1]).monitors, etlc.commands.command_path())
' "$box/t.etl") || fail "import etlc"
[ "$said" = "$version ('m',) $box/root/usr/bin/etlc" ] || fail "the Python package says: $said"
