#!/bin/sh
# What a new user does: the first block of README's "Add it", line by line, in an empty folder beside this
# repository. Needs a driver, since it ends with a picture.
set -eu
cd "$(dirname "$0")/.."
. scripts/driver.sh
need_cargo
need_driver

repository=$PWD
target=${CARGO_TARGET_DIR:-$PWD/target}
lines=$(awk '/^```sh$/ { inside = 1; next } /^```$/ && inside { exit } inside' README.md)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
ln -s "$repository" "$folder/shadows"
cd "$folder"
# Kept for the next run; of the versions that Cargo.lock has, so that another crate's release of today
# breaks nothing here.
export CARGO_TARGET_DIR="$target/new_user" CARGO_PROFILE_DEV_DEBUG=0
(cd shadows && cargo fetch --locked --quiet) && export CARGO_NET_OFFLINE=true
printf '%s\n' "$lines"
eval "set -e
$lines"
test -s "$PWD/target/first_shadow.png"
