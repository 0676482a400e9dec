#!/bin/sh
# Whether the library compiles with the oldest release of each dependency that Cargo.toml allows, and with
# the oldest Rust, where rustup has that: 1.88, with `reference` 1.89.
set -eu
cd "$(dirname "$0")/.."
. scripts/driver.sh
need_cargo

target=${CARGO_TARGET_DIR:-$PWD/target}
copy=$target/versions
rm -rf "$copy"
mkdir -p "$copy/docs"
cp -r src shaders README.md "$copy"
cp docs/picture.md "$copy/docs"
# Without what only tests, examples and benches need: a user's graph has none of it.
awk '/^\[/ { wanted = !/dev-dependencies|\[(bench|example|test)\]\]|workspace/ } wanted' Cargo.toml >"$copy/Cargo.toml"
cd "$copy"
export CARGO_TARGET_DIR="$target"

# $1: a toolchain; the rest: features.
check() {
    toolchain=$1
    shift
    if [ "$toolchain" = default ]; then
        cargo check --lib --locked --quiet "$@"
    elif rustup run "$toolchain" cargo --version >/dev/null 2>&1; then
        RUSTUP_TOOLCHAIN=$toolchain cargo check --lib --locked --quiet "$@"
    else
        echo "Rust $toolchain is not installed here: not checked (rustup toolchain install $toolchain)" >&2
    fi
}

# A flag of nightly cargo, for which this variable makes any cargo take it. Only the lock file is made so.
RUSTC_BOOTSTRAP=1 cargo generate-lockfile -Z direct-minimal-versions --quiet
check default
check default --features reference
check 1.88
check 1.89 --features reference
