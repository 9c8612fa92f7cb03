#!/usr/bin/env bash
# stranger.sh RELEASE: does what a new user does with a release, in a Debian 12 that has nothing
# else: README.md's commands, in order, with the output that is printed there; first with the Debian
# packages, then with the wheel. Needs root, mmdebstrap and a Debian mirror. Says how long it takes
# from the wheel to the first verdicts.
set -euo pipefail
release=$(cd "$1" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
box=$(mktemp -d)
root=$box/root
trap 'rm -rf "$box"' EXIT
fail() { echo "FAILED: $*"; tail -n 40 "$box/log"; exit 1; }
# inside COMMANDS: runs them in the empty system.
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 HOME=/root \
    DEBIAN_FRONTEND=noninteractive bash -ec "cd /release; $1" >"$box/log" 2>&1; }

(cd "$release" && sha256sum --quiet -c SHA256SUMS) >"$box/log" 2>&1 || fail "SHA256SUMS"
mmdebstrap --quiet --mode=root --variant=apt bookworm "$root" >"$box/log" 2>&1 ||
    fail "there is no empty Debian"
cp -r "$release" "$root/release"
mkdir "$root/play"
cp "$here/../examples/tutorial_test.sh" "$root/play"
tar -C "$root/play" --strip-components=1 -xzf "$release"/etlc-*.tar.gz --wildcards '*/README.md'
readme=$root/play/README.md
# file NAME: the file of that name in README.md.
file() { sed -n "/ file=$1\$/,/^\`\`\`\$/p" "$readme" | sed '1d;$d'; }
# line COMMAND: the line of README.md that installs a release with it, less the command.
line() { sed -n '/^## Install/,/^## In Python/s/^    '"$1"' install \([^#]*[^ #]\) *#.*/\1/p' \
    "$readme" | grep . || fail "README.md does not install a release with $1"; }

packages=$(line apt) wheel=$(line pip)
get="apt-get -qq --no-install-recommends"
inside "$get update; $get install $packages" || fail "apt install $packages"
inside "$get install python3-numpy python3-venv" || fail "what Python needs"
inside "/play/tutorial_test.sh /usr/bin/etlc /usr/include /play/README.md" ||
    fail "README.md with the Debian packages"
echo "With the Debian packages README.md prints what it says."

inside "apt-get -qq purge etlc; python3 -m venv --system-site-packages /venv
    ! command -v etlc" || fail "the packages are still there"
file dock.etl >"$root/play/dock.etl"
file drive.py >"$root/play/drive.py"
started=$(date +%s%N)
inside ". /venv/bin/activate; pip install --quiet $wheel; cd /play; python3 drive.py" ||
    fail "pip install $wheel"
seconds=$(awk "BEGIN { printf \"%.1f\", ($(date +%s%N) - $started) / 1e9 }")
grep -q "<arrive: satisfied for good" "$box/log" || fail "no verdict with the wheel"
inside ". /venv/bin/activate; /play/tutorial_test.sh /venv/bin/etlc /none /play/README.md" ||
    fail "README.md with the wheel"
echo "With the wheel too. From the wheel to the first verdicts: $seconds s."
