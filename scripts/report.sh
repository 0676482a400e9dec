#!/bin/sh
# Everything that docs/ says in figures, measured anew on this machine: speed against error, the hard
# cases, flips over time, growth. For a GPU: on a software driver the sweep's maps of 4096 texels take long,
# and all its maps together more than 20 GB.
set -eu
cd "$(dirname "$0")/.."
. scripts/driver.sh
need_cargo
need_compiler
need_driver

compare() {
    cargo run --release --quiet --example compare -- "$@"
}

compare --sweep --scene courtyard --size 640x360 --out target/sweep
cp target/sweep/sweep.md docs/speed-vs-error.md
cp target/sweep/speed-vs-error.svg docs/
compare --hard-cases --out docs
compare --temporal --technique all --out docs
compare --growth --out docs
