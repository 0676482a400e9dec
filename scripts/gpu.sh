#!/bin/sh
# One file with everything that is worth running on a GPU, for a Linux machine without Rust:
#
#   scripts/gpu.sh [--dev] [FILE]     makes FILE (target/shadows-gpu.run)
#
# There: `sh FILE OUT [SECONDS [PART...]]`; scripts/gpu_run.sh says what that does. It needs a Vulkan driver,
# a C library at least as new as the one here, bash, tar and gzip. Vulkan's loader and zstd are carried along
# from this machine.
#
# Tests are built as test.sh builds them; benches and `compare` with --release, or with --dev by the dev
# profile with all optimisations but with its assertions: GPU times are the same, ratios of CPU times are not.
#
# All test binaries that ask for a GPU are packed. Those that need none have nothing to say there, and so none
# is packed that needs cargo or the source tree.
set -eu
cd "$(dirname "$0")/.."
. scripts/driver.sh
need_cargo
need_compiler

measured=--release
if [ "${1:-}" = --dev ]; then
    measured='--profile dev'
    shift
fi
file=${1:-target/shadows-gpu.run}
benches='adjacency cube_map operations pcf shadow_volume' # shader_cost needs Mesa's compiler, no GPU
made=target/gpu
rm -rf "$made"
mkdir -p "$made/all/deps" "$made/all/examples" "$made/all/benches" "$made/tools" "$(dirname "$file")"

# Builds, and puts each executable without its symbols into a folder, under its target's name; with TEXT,
# only those that hold it.
build() {
    folder=$made/all/$1
    text=$2
    shift 2
    cargo "$@" --all-features --message-format json-render-diagnostics >"$made/messages"
    sed -n 's/.*"name":"\([^"]*\)",.*"executable":"\([^"]*\)".*/\1 \2/p' "$made/messages" >"$made/executables"
    while read -r name path; do
        if grep -q "$text" "$path"; then
            strip -o "$folder/$name" "$path"
        fi
    done <"$made/executables"
}

build deps 'skipped: no \(GL \)*adapter' test --no-run --tests
rm -f "$made/all/deps/tool" # starts `compare` where cargo has put it
[ "$measured" = --release ] || export CARGO_PROFILE_DEV_OPT_LEVEL=3
# shellcheck disable=SC2086
build examples '' build $measured --example compare
# shellcheck disable=SC2086,SC2046
build benches '' bench $measured --no-run $(printf ' --bench %s' $benches)

cp scripts/gpu_run.sh "$made/all/run.sh"
{
    git describe --always --dirty --abbrev=12
    [ "$measured" = --release ] && echo 'benches and compare: release' || echo 'benches and compare: dev, opt-level 3'
} | paste -sd, >"$made/all/version"

# With the libraries that are not the C library's.
carry() {
    cp -L "$1" "$2"
    ldd "$1" | sed -n 's|.* => \(/[^ ]*\) .*|\1|p' |
        grep -Ev '/(libc|libm|libdl|libpthread|librt|libgcc_s)\.so' | while read -r library; do
            cp -L "$library" "$2"
        done
}
mkdir -p "$made/all/loader"
loader=$(ldconfig -p | sed -n 's|.*libvulkan\.so\.1 .*x86-64.* => ||p' | head -n 1)
if [ -n "$loader" ]; then
    carry "$loader" "$made/all/loader"
else
    echo 'No Vulkan loader here: the other machine must have one.' >&2
fi
carry "$(command -v zstd)" "$made/tools"

# The binaries have most of their code in common, at distances that only a window as long as all of them sees.
tar -C "$made/all" --sort=name -c . | zstd --quiet -12 -T0 --long=31 -o "$made/all.tar.zst"
cat >"$made/head" <<'HEAD'
#!/bin/sh
# See scripts/gpu.sh and scripts/gpu_run.sh of the crate `shadows`: sh FILE OUT [SECONDS [PART...]]
set -eu
at=$(mktemp -d "${TMPDIR:-/tmp}/shadows-gpu.XXXXXX")
trap 'rm -rf "$at"' EXIT
tail -n +10 "$0" | tar -xf - -C "$at"
LD_LIBRARY_PATH=$at/tools "$at/tools/zstd" -qdc --long=31 "$at/all.tar.zst" | tar -xf - -C "$at"
bash "$at/run.sh" "$@"
exit $?
HEAD
tar -C "$made" -cf - tools all.tar.zst | cat "$made/head" - >"$file"
chmod +x "$file"
ls "$made/all/deps" | paste -sd' ' | sed 's/^/tests: /'
echo "$file: $(($(stat -c %s "$file") / 1048576)) MiB"
