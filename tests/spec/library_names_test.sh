#!/usr/bin/env bash
# library_names_test.sh CHECK_NAMES CXX: names that the headers of C and POSIX declare at global
# scope are refused for specs, and their macros for everything. CHECK_NAMES prints the names that
# etlc allows. The compiler finds the clashes: it compiles a declaration of a namespace, or a field,
# with each name after all headers. ETLC_UPDATE=1 adds the declarations of this machine's headers
# beyond the standards to compiler/check/names/library_names.inc.
. "$(dirname "$0")/../box.bash"
check_names=$1
cxx=$2
table=$here/../../compiler/check/names/library_names.inc

headers="assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp signal
  stdalign stdarg stdbool stddef stdint stdio stdlib string time uchar wchar wctype aio
  arpa/inet cpio dirent dlfcn fcntl fmtmsg fnmatch ftw glob grp iconv langinfo libgen
  monetary mqueue net/if netdb netinet/in netinet/tcp nl_types poll pthread pwd regex sched
  search semaphore spawn strings sys/ipc sys/mman sys/msg sys/resource sys/select sys/sem
  sys/shm sys/socket sys/stat sys/statvfs sys/time sys/times sys/types sys/uio sys/un
  sys/utsname sys/wait syslog tar termios ulimit unistd utime utmpx wordexp"
# Without an update only names of the standards are checked: a later C library may add names.
compile=("$cxx" -std=c++17 -w)
[ -n "${ETLC_UPDATE:-}" ] || compile+=(-U_GNU_SOURCE -D_XOPEN_SOURCE=700)
for header in $headers; do
    printf '#if __has_include(<%s.h>)\n#include <%s.h>\n#endif\n' "$header" "$header"
done >headers.hpp

# clashing TEXT: the names in candidates.txt for which TEXT, with & replaced by the name, does not
# compile.
clashing() {
    { cat headers.hpp; sed "s/.*/$1/" candidates.txt; echo "struct LastLine;"; } >probe.cpp
    "${compile[@]}" -fmax-errors=0 -fsyntax-only probe.cpp 2>errors.txt || true
    grep -oE '^probe.cpp:[0-9]+:[0-9]+: error' errors.txt | cut -d: -f2 |
        awk -v before="$(wc -l <headers.hpp)" '$1 > before { print $1 - before }' |
            sort -nu >lines.txt
    awk 'NR == FNR { clash[$1]; next } FNR in clash' lines.txt candidates.txt
}

{
    "${compile[@]}" -E -P -x c++ headers.hpp | grep -oE '[A-Za-z_][A-Za-z_0-9]*'
    "${compile[@]}" -E -dM -x c++ headers.hpp | cut -d' ' -f2 | cut -d'(' -f1
} | LC_ALL=C sort -u | grep -E '^[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*$' >candidates.txt
clashing 'struct etlc_probe_& { float &; };' >fields.txt
clashing 'namespace & { struct Inside; }' >namespaces.txt
[ "$(wc -l <fields.txt)" -gt 500 ] && [ "$(wc -l <namespaces.txt)" -gt 1500 ]

if [ -n "${ETLC_UPDATE:-}" ]; then
    "$check_names" field <namespaces.txt >new.txt  # the others are already refused as fields
    { grep -oE '"[^"]+"' "$table" | tr -d '"' || true; cat new.txt; } | LC_ALL=C sort -u |
        sed 's/.*/"&",/' | awk '  # formatted like clang-format
            NR > 1 && length(line) + 1 + length($0) > 100 { print line; line = "   " }
            { line = line (NR > 1 ? " " : "") $0 }
            END { print line }' >updated.inc
    cp updated.inc "$table"
    exit 0
fi
failed=0
for kind in field namespace; do
    "$check_names" $kind <${kind}s.txt >missed.txt
    if [ -s missed.txt ]; then
        echo "FAILED: may be declared as a $kind, and clashes with a header of C:" $(head \
            -40 missed.txt)
        failed=1
    fi
done
exit $failed
