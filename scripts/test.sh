#!/bin/sh
# All tests. Set SHADOWS_REQUIRE_GPU=1 to fail rather than skip where no driver is found.
set -eu
cd "$(dirname "$0")/.."
. scripts/driver.sh
need_cargo
need_compiler
need_driver || [ -z "${SHADOWS_REQUIRE_GPU:-}" ]

cargo test --quiet --all-features "$@"
