#!/bin/sh
# The page in the browser (examples/web), by Rust and node:
#   scripts/web.sh          builds examples/web/dist, small
#   scripts/web.sh debug    builds it quickly
#   scripts/web.sh serve    serves it on http://localhost:8000 (PORT)
#   scripts/web.sh test     tries it in headless Chromium (CHROMIUM), against pictures drawn natively
set -eu
cd "$(dirname "$0")/../examples/web"

# $1: a profile of cargo.
build() {
    rustup target list --installed 2>/dev/null | grep -q wasm32-unknown-unknown ||
        rustup target add wasm32-unknown-unknown
    cargo build --quiet --locked --lib --target wasm32-unknown-unknown --profile "$1"
    folder=$1
    [ "$folder" != dev ] || folder=debug
    rm -rf dist
    mkdir dist
    cargo run --quiet --locked --manifest-path bindgen/Cargo.toml -- \
        "target/wasm32-unknown-unknown/$folder/shadows_web.wasm" dist
    cp page/* dist/
}

case ${1:-} in
'')
    build release
    node test/size.mjs dist
    ;;
debug) build dev ;;
serve) exec node test/serve.mjs dist "${PORT:-8000}" ;;
test)
    shift
    exec node test/test.mjs "$@"
    ;;
*)
    sed -n '2,6s/^# \{0,1\}//p' "$0" >&2
    exit 2
    ;;
esac
