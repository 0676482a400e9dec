#!/bin/sh
# The main job: renders the three built-in scenes with every technique, measures time and error,
# and says where pictures and report are. Further arguments go to the example.
set -eu
cd "$(dirname "$0")/.."
. scripts/driver.sh
need_cargo
need_compiler
need_driver

out=target/demo
cargo run --release --quiet --example compare -- \
    --scene spheres --scene courtyard --scene teapot --out "$out" "$@"
echo
echo "Report and pictures:"
for scene in spheres courtyard teapot; do
    echo "  $out/$scene/report.md"
done
