#!/bin/sh
# The package as crates.io would get it: made from the working tree, unpacked into target/package, and a
# command run there, as in `scripts/package.sh cargo test --all-features`. Dependencies that the tree has
# built are not built again.
set -eu
cd "$(dirname "$0")/.."

target=${CARGO_TARGET_DIR:-$PWD/target}
package=$target/package
cargo package -p shadows --no-verify --allow-dirty --quiet --target-dir "$target"
archive=$(ls -t "$package"/shadows-*.crate | head -n 1)
rm -rf "${archive%.crate}"
# Times of now: those in the archive are all one, and cargo would take a change for none.
tar -xzmf "$archive" -C "$package"
cd "${archive%.crate}"
export CARGO_TARGET_DIR="$target"
"$@"
