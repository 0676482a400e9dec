#!/bin/sh
# docs/picture.md, the picture in the crate's documentation: small, and within the text, since docs.rs shows
# no files of a package.
set -eu
cd "$(dirname "$0")/.."
. scripts/driver.sh
need_cargo
need_driver

cargo run --release --quiet --example compare -- \
    --scene courtyard --technique volume --size 400x225 --frames 1 --out target/picture
printf '![A courtyard at night, its columns, railings and chains throwing sharp shadows](data:image/png;base64,%s)\n' \
    "$(base64 -w0 target/picture/volume.shaded.png)" >docs/picture.md
