#!/bin/sh
# The tests on other drivers than the system's first, and WGSL in other compilers than naga. Everything goes into
# a folder of its own, SHADOWS_DRIVERS (~/.cache/shadows-drivers): nothing is installed into the system, no root
# is needed.
#
#   scripts/drivers.sh install [PART...]          swiftshader mesa tint validators (all; Debian and Ubuntu, npm)
#   scripts/drivers.sh run [DRIVER...] [-- SUITE...]   a table of suites by drivers, of those that are there
#   scripts/drivers.sh short                      what CI runs: some suites of seconds, on what is installed
#   scripts/drivers.sh validate SUITE...          under Vulkan's validation layer, with synchronisation
#
# Drivers: lavapipe (the system's Mesa), mesa (Debian trixie's), swiftshader, gl (the system's Mesa on wgpu's GL).
# What a suite printed is in target/drivers/DRIVER/SUITE.txt. docs/drivers.md says what came out and why; `run` fails
# if other tests fail than those that stand there, or if one of them passes.
set -eu
cd "$(dirname "$0")/.."
. scripts/driver.sh

folder=${SHADOWS_DRIVERS:-${XDG_CACHE_HOME:-$HOME/.cache}/shadows-drivers}
out=target/drivers
chromium=$folder/swiftshader/usr/lib/chromium
# In seconds. One test may compile shaders for minutes on a software driver; none takes so long that works, but on a
# machine that is busy with other work.
limit=${SHADOWS_DRIVERS_LIMIT:-900}

# $1: a folder there; the rest: packages of this system's release, unpacked into it without their dependencies.
unpack() {
    into=$folder/$1
    shift
    rm -rf "$into" && mkdir -p "$into/packages"
    (cd "$into/packages" && apt-get download -qq "$@")
    for package in "$into"/packages/*.deb; do dpkg -x "$package" "$into"; done
    rm -rf "$into/packages"
}

# Chromium has SwiftShader, and a validation layer newer than Debian's.
install_swiftshader() {
    unpack swiftshader chromium-common
    # The rest of Chromium is not of use.
    find "$chromium" -type f ! -name '*vk_swiftshader*' ! -name '*VkLayer*' -delete
    cat >"$chromium/VkLayer_khronos_validation.json" <<EOF
{"file_format_version": "1.2.0", "layer": {"name": "VK_LAYER_KHRONOS_validation", "type": "GLOBAL",
"library_path": "./libVkLayer_khronos_validation.so", "api_version": "1.3.0", "implementation_version": "1",
"description": "Khronos Validation Layer", "instance_extensions": [
{"name": "VK_EXT_debug_report", "spec_version": "10"}, {"name": "VK_EXT_debug_utils", "spec_version": "1"},
{"name": "VK_EXT_validation_features", "spec_version": "6"}, {"name": "VK_EXT_layer_settings", "spec_version": "2"}]}}
EOF
}

# A newer Mesa with all that it is linked with, down to the C library: run by that one's own loader.
install_mesa() {
    root=$folder/mesa
    apt=$folder/mesa-apt
    rm -rf "$root" "$apt" && mkdir -p "$root" "$apt/lists/partial" "$apt/archives/partial"
    : >"$apt/status"
    keys=/usr/share/keyrings/debian-archive-keyring.gpg
    echo "deb [signed-by=$keys] http://deb.debian.org/debian trixie main" >"$apt/sources.list"
    # As if nothing were installed, so that nothing is left out.
    set -- -qq -o Dir::Etc::SourceList="$apt/sources.list" -o Dir::Etc::SourceParts=/dev/null \
        -o Dir::State::Lists="$apt/lists" -o Dir::State::status="$apt/status" \
        -o Dir::Cache::Archives="$apt/archives" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= \
        -o APT::Install-Recommends=false
    apt-get "$@" update
    apt-get "$@" -y --download-only install mesa-vulkan-drivers libvulkan1
    for package in "$apt"/archives/*.deb; do dpkg -x "$package" "$root"; done
    rm -rf "$apt"
}

# Dawn, prebuilt for node.
install_tint() {
    mkdir -p "$folder/tint"
    (cd "$folder/tint" && npm install --silent --no-audit --no-fund webgpu)
}

install_validators() {
    unpack validators glslang-tools spirv-tools
}

# Where a driver's own files are; nothing where it is not.
manifest() {
    case $1 in
    lavapipe) ls /usr/share/vulkan/icd.d/lvp_icd.*.json 2>/dev/null ;;
    mesa) ls "$folder"/mesa/usr/share/vulkan/icd.d/lvp_icd*.json 2>/dev/null ;;
    swiftshader) ls "$chromium/vk_swiftshader_icd.json" 2>/dev/null ;;
    gl) ldconfig -p | grep -o '/.*libEGL_mesa\.so\.0$' ;;
    *)
        echo "no driver $1; see the head of scripts/drivers.sh" >&2
        exit 2
        ;;
    esac
}

# $1: a driver; the rest: a command, run on it.
on() {
    driver=$1
    shift
    files=$(manifest "$driver" | head -n 1)
    adapter=llvmpipe
    case $driver in
    swiftshader) adapter=swiftshader ;;
    gl) files=/none adapter='(gl,' ;;
    mesa)
        libraries=$(echo "$folder"/mesa/usr/lib/*-linux-gnu)
        loader=$(ls "$folder"/mesa/usr/lib*/ld-linux-*.so.* | head -n 1)
        # The variable is for a test that starts itself anew.
        set -- env "SHADOWS_TEST_LOADER=$loader --library-path $libraries" \
            "$loader" --library-path "$libraries" "$@"
        ;;
    esac
    SHADOWS_REQUIRE_GPU=1 SHADOWS_TEST_ADAPTER=$adapter VK_DRIVER_FILES=$files VK_ICD_FILENAMES=$files \
        XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-/tmp}" timeout "$limit" "$@"
}

# Where each module is a suite of its own.
folders='tests/maps tests/receivers examples/compare/tests/measured'

# The test binary that a suite is in. `volume::passes` is a part of `volume`; two binaries may have a part of one
# name, which stands with the binary's then.
home() {
    case $1 in
    lib | gl | survey | volume | *::*)
        echo "${1%%::*}"
        return
        ;;
    esac
    for folder in $folders; do
        [ ! -e "$folder/$1.rs" ] || basename "$folder"
    done
}

# Every part of those binaries that draws.
drawing() {
    for folder in $folders; do
        for file in $(grep -l 'host::gpu' "$folder"/*.rs); do
            name=$(basename "$file" .rs)
            [ "$(home "$name" | wc -l)" -eq 1 ] || name=$(basename "$folder")::$name
            echo "$name"
        done
    done
}

# The tests that draw, or those of them that are named: `SUITE BINARY FILTER` for each.
suites() {
    if [ $# -eq 0 ]; then
        # shellcheck disable=SC2046
        set -- lib gl survey volume $(drawing)
    fi
    targets=
    for suite in "$@"; do
        case $(home "$suite") in
        '' | *[[:space:]]*)
            echo "$suite: no suite, or parts of two; see the head of scripts/drivers.sh" >&2
            return 1
            ;;
        lib) targets="$targets --lib" ;;
        *) targets="$targets --test $(home "$suite")" ;;
        esac
    done
    # shellcheck disable=SC2086
    cargo test --no-run --all-features $targets 2>&1 |
        sed -n 's#.*Executable .*(\(.*/deps/\([a-z]*\)-[0-9a-f]*\))#\2 \1#p' | sed 's/^shadows /lib /' >"$out/binaries"
    for suite in "$@"; do
        home=$(home "$suite")
        filter=
        [ "$home" = "$suite" ] || filter=${suite#"$home"::}::
        binary=$(sed -n "s/^$home //p" "$out/binaries")
        if [ -z "$binary" ]; then
            echo "$suite: $home was not built; see what cargo test --no-run --all-features says" >&2
            return 1
        fi
        echo "$suite $binary $filter"
    done
}

# Tests that are known to fail there: the rows `| DRIVER | `SUITE` | `TEST` | cause |` of the page.
known() {
    awk -F ' *[|] *' -v driver="$1" -v suite="\`$2\`" '$2 == driver && $3 == suite { print $4 }' docs/drivers.md |
        tr -d '`' | tr ',' '\n' | tr -d ' ' | sort
}

# What a suite's output comes to, in a cell. $3: how it ended.
cell() {
    failed=$(sed -n -e "s/^test ${2#*::}::/test /" -e 's/^test \(.*\) \.\.\. FAILED$/\1/p' "$out/$1/$2.txt" | sort)
    passed=$(grep -c '^test .* \.\.\. ok$' "$out/$1/$2.txt" || true)
    count=$(printf '%s' "$failed" | grep -c . || true)
    if [ "$3" -eq 124 ]; then
        echo "stopped after $limit s"
    elif [ "$failed" != "$(known "$1" "$2")" ]; then
        echo "**$passed of $((passed + count))**, not as known: $(echo $failed)"
    elif [ "$3" -ne 0 ] && [ "$count" -eq 0 ]; then
        echo "**ended with $3**"
    elif [ "$count" -gt 0 ]; then
        echo "$passed of $((passed + count))"
    else
        echo "$passed"
    fi
}

# A column of the table; $1: a driver.
column() {
    driver=$1
    mkdir -p "$out/$driver"
    while read -r suite binary filter; do
        code=0
        # shellcheck disable=SC2086
        on "$driver" "$binary" $filter >"$out/$driver/$suite.txt" 2>&1 </dev/null || code=$?
        cell "$driver" "$suite" "$code" >"$out/$driver/$suite.cell"
        echo "$driver: $suite: $(cat "$out/$driver/$suite.cell")" >&2
    done <"$out/suites"
}

table() {
    printf '| suite |'
    for driver in "$@"; do printf ' %s |' "$driver"; done
    printf '\n|---|'
    for driver in "$@"; do printf -- '---|'; done
    echo
    while read -r suite _; do
        printf '| `%s` |' "$suite"
        for driver in "$@"; do printf ' %s |' "$(cat "$out/$driver/$suite.cell")"; done
        echo
    done <"$out/suites"
}

# Fails if any suite did.
run() {
    drivers=
    while [ $# -gt 0 ] && [ "$1" != -- ]; do
        drivers="$drivers $1"
        shift
    done
    [ $# -eq 0 ] || shift
    [ -n "$drivers" ] || drivers='lavapipe mesa swiftshader gl'
    mkdir -p "$out"
    suites "$@" >"$out/suites"
    [ -s "$out/suites" ]
    there=
    for driver in $drivers; do
        if [ -z "$(manifest "$driver")" ]; then
            echo "$driver: not here; see scripts/drivers.sh install" >&2
            continue
        fi
        column "$driver"
        there="$there $driver"
    done
    table $there
    while read -r suite _; do
        for driver in $there; do ! grep -qE '[*]|stopped' "$out/$driver/$suite.cell" || return 1; done
    done <"$out/suites"
}

# Mesa's and SwiftShader's rasterisers on depths, samplers on whole numbers, and every call once; Vulkan's own
# rules on maps and volumes.
short() {
    if [ -e "$chromium/VkLayer_khronos_validation.json" ]; then
        validate map_calls volume::flat_end volume::one_pass volume::without_stencil
    else
        echo 'no validation layer is installed here (scripts/drivers.sh install swiftshader): not run' >&2
    fi
    if [ -z "$(manifest mesa)$(manifest swiftshader)" ]; then
        echo 'no other driver is installed here (scripts/drivers.sh install): not run' >&2
        return 0
    fi
    run mesa swiftshader -- depth_planes cube_formats pcf_gather map_calls
}

# What Vulkan's rules say of naga and wgpu, whatever a host does; docs/drivers.md has the causes.
known_rules='VUID-StandaloneSpirv-None-10684|VUID-VkGraphicsPipelineCreateInfo-pDynamicStates-00754'
known_rules=$known_rules'|SYNC-HAZARD-WRITE-AFTER-WRITE .*vkCmdEndRenderPass.* during an image layout transition'

# Vulkan's own rules, hazards between passes included, on lavapipe. The layer must have been there, and must have
# said nothing beside what is known.
validate() {
    if [ ! -e "$chromium/VkLayer_khronos_validation.json" ]; then
        echo 'no validation layer here; scripts/drivers.sh install swiftshader' >&2
        return 1
    fi
    mkdir -p "$out/validate"
    suites "$@" >"$out/suites"
    said=0
    for suite in "$@"; do
        log=$PWD/$out/validate/$(echo "$suite" | tr -s : -).txt
        rm -f "$log"
        cat >"$out/validate/vk_layer_settings.txt" <<EOF
khronos_validation.debug_action = VK_DBG_LAYER_ACTION_LOG_MSG
khronos_validation.log_filename = $log
khronos_validation.report_flags = error,warn,perf
khronos_validation.validate_sync = true
khronos_validation.enable_message_limit = false
EOF
        binary=$(sed -n "s/^$suite //p" "$out/suites") # and its filter
        # shellcheck disable=SC2086
        VK_LAYER_PATH=$chromium VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation \
            VK_LAYER_SETTINGS_PATH=$PWD/$out/validate on lavapipe $binary >"$log.out" 2>&1 || said=1
        if ! grep -q 'Validation Layer Info' "$log.out"; then
            echo "$suite: the layer was not loaded, see $log.out" >&2
            return 1
        fi
        # Each with the line that says where; threads may write into each other's lines.
        rules=$(awk '/Validation (Error|Warning|Performance)/ { rule = $0; getline; print rule " " $0 }' "$log")
        new=$(printf '%s' "$rules" | grep -cvE "$known_rules" || true)
        all=$(printf '%s' "$rules" | grep -c . || true)
        echo "$suite: $(grep 'test result' "$log.out"), $new messages, $((all - new)) known"
        [ "$new" -eq 0 ] || said=1
    done
    return $said
}

[ $# -gt 0 ] || set -- help
command=$1
shift
case $command in
install)
    [ $# -gt 0 ] || set -- swiftshader mesa tint validators
    for part in "$@"; do "install_$part"; done
    ;;
run) run "$@" ;;
short) short ;;
validate) validate "$@" ;;
*)
    sed -n '2,15s/^# \{0,1\}//p' scripts/drivers.sh >&2
    exit 2
    ;;
esac
