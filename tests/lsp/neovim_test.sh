#!/usr/bin/env bash
# neovim_test.sh NVIM ETLC PAGE: runs a session in Neovim's own client, with the settings that PAGE,
# docs/editors.md, gives for Neovim 0.7.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT
cat >"$box/dock.etl" <<'SPEC'
spec dock;

input z : f32[2];
target bay = [[1, 0], [0, 1]];

predicate at_bay = min cosine(z, bay) <= 0.25;
/* 🚀🤖 */ monitor arrive = F at_bai;
SPEC
cd "$box"
awk '/^Neovim 0.7/ { found = 1 }
     found && /^```$/ { exit }
     inside { print }
     found && /^```lua$/ { inside = 1 }' "$3" >init.lua
[ -s init.lua ] || { echo "FAILED: the page has no settings for Neovim 0.7"; exit 1; }
export SPEC=dock.etl PATH=$(dirname "$2"):$PATH
export XDG_CONFIG_HOME=$box/config XDG_DATA_HOME=$box/data XDG_STATE_HOME=$box/state
export XDG_CACHE_HOME=$box/cache LC_ALL=C.UTF-8
"$1" --headless -u init.lua -i NONE -c "luafile $here/neovim_test.lua"
[ ! -e "$box/cache/nvim/lsp.log" ] || ! grep -a '^\[ERROR\]' "$box/cache/nvim/lsp.log"
