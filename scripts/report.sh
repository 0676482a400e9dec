#!/bin/sh
# The measured pages of docs/, anew on this machine: speed against error, growth, the hard cases, flips
# over time. (docs/benches.md is written by hand from `cargo bench`.) Leave the machine alone for the first two, which are times.
set -eu
cd "$(dirname "$0")/.."
. scripts/driver.sh
need_cargo
need_compiler
need_driver

compare() {
    cargo run --release --quiet --example compare -- "$@"
}

compare --sweep --scene courtyard --error-at-most 0.001 --time-at-most 40ms --out target/sweep
cp target/sweep/sweep.md docs/speed-vs-error.md
cp target/sweep/speed-vs-error.svg docs/
compare --growth --frames 16 --out docs
compare --hard-cases --out docs
compare --temporal --technique all --out docs
