#!/usr/bin/env bash
# deb_test.sh BUILD_DIR CPACK VERSION: makes the Debian packages and checks their contents.
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
for library in avcodec libpng libjpeg openmpi httplib libssl; do
    [[ $depends != *"$library"* ]] || fail "etlc itself depends on $library: $depends"
done
dpkg-deb -x "$deb" "$box/root"
# Each helper that is built has its own package, with the libraries that it needs.
for helper in "embed embed-video=libavcodec" mpi=libopenmpi \
    serve=libcpp-httplib; do
    library=${helper#*=} programs=(${helper%=*})
    name=etlc-${programs[0]}
    [ ! -e "$box/root/usr/libexec/etlc/$name" ] || fail "etlc holds $name"
    [ -e "$build_dir/$name" ] || continue
    own=$(echo "$box/$name"_"$version"_*.deb)
    [ -f "$own" ] || { ls "$box"; fail "there is no package $name"; }
    depends=$(dpkg-deb -f "$own" Depends)
    [[ $depends == *"$library"* && $depends == *"etlc (= $version)"* ]] ||
        fail "$name depends on $depends"
    dpkg-deb -x "$own" "$box/$name"
    [ "$(cd "$box/$name" && find . -type f -o -type l | sort)" = \
        "$(printf './usr/libexec/etlc/etlc-%s\n' "${programs[@]}")" ] ||
        fail "$name holds: $(find "$box/$name")"
done
[[ $("$box/root/usr/bin/etlc" --version) == *"$version"* ]] ||
    fail "etlc --version does not say $version"
for file in include/etlmon/temporal/value.hpp share/cmake/etlc/etlcConfig.cmake \
    share/cmake/etlc/EtlAddMonitor.cmake share/doc/etlc/copyright include/etlc.h \
    lib/libetlc.so lib/libetlc.so.1 lib/pkgconfig/etlc.pc share/man/man1/etlc.1 \
    share/bash-completion/completions/etlc; do
    [ -f "$box/root/usr/$file" ] || fail "it lacks /usr/$file"
done

# A program beside etlc's folder reads HDF5 files, wherever the package is unpacked.
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

# Python finds the package, and the package finds the library and the command, wherever it is
# unpacked.
said=$(env -u LD_LIBRARY_PATH -u ETLC_LIBRARY -u ETLC_COMMAND PYTHONDONTWRITEBYTECODE=1 \
    PYTHONPATH=$box/root/usr/lib/python3/dist-packages \
    /usr/bin/python3 -c 'import etlc, sys
print(etlc.__version__, etlc.Monitor(sys.argv[1]).monitors, etlc._process.command_path())
' "$box/t.etl") || fail "import etlc"
[ "$said" = "$version ('m',) $box/root/usr/bin/etlc" ] || fail "the Python package says: $said"
