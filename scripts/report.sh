#!/bin/sh
# The pictures of README.md and docs/ and the figures between markers there, anew on this machine. Other tables say
# beside them by which command they were made.
#
#   scripts/report.sh             all of them (an hour on two cores)
#   scripts/report.sh PART...     some: scenes kernels cheap gallery volume-debug volume-start picture models
#                                 egui web speed-vs-error cost-vs-error growth hard-cases temporal benches
#   scripts/report.sh --check     whether those that take seconds are what it makes, times aside
#   SMALL=1 scripts/report.sh ..  tries the script itself: the least sizes, docs/ left alone
#
# Leave the machine alone for scenes, speed-vs-error, growth and benches, which are times. `models` wants
# MODELS, a directory with stanford-bunny.obj, suzanne.obj and beetle.obj; `egui` a display, or xvfb-run;
# `web` node and Chromium.
# BENCH_RUNS (3) is how often the benches run, to say how far their ratios scatter.
#
# Figures stand between <!-- NAME --> and <!-- /NAME -->, which is where they are put.
set -eu
cd "$(dirname "$0")/.."
. scripts/driver.sh
. scripts/figures.sh

made=target/report
profile=--release
# What is written to: README.md and docs/, or copies of them.
readme=README.md
docs=docs

example() {
    name=$1
    shift
    cargo run $profile --quiet --all-features --example "$name" -- "$@"
}

compare() {
    example compare "$@"
}

# The three built-in scenes: the gallery's first picture and README's table.
scenes() {
    techniques=volume,cube-hard,cube-2x2,cube-16,cube-cached,cube-textbook
    compare --scene spheres --scene courtyard --scene teapot --technique $techniques \
        --frames "${frames:-12}" ${size:-} --out $made/scenes
    cp $made/scenes/courtyard/volume.shaded.png $docs/courtyard.png
    put scenes $readme <$made/scenes/scenes.md
    cast=$(sed -n 's/.* cast (\([0-9]*\) triangles.*/\1/p' $made/scenes/courtyard/report.md)
    thousands "$cast" | put courtyard-casters $docs/gallery.md
}

kernels() {
    example kernel_sheet --kernels $docs/kernels.png
    example kernel_sheet --peers $docs/peers.png
    example kernel_sheet --difference $docs/difference.png
}

# The courtyard by day and by night, and two loops.
gallery() {
    [ -z "${SMALL:-}" ] || return 0
    example gallery --day $docs/courtyard-day.png
    example gallery --night $docs/courtyard-night.png
    example gallery --sun $docs/sun.png
    example gallery --pan $docs/pan.png
}

# The cheap and the baked techniques side by side.
cheap() {
    example cheap_sheet $docs/cheap.png
}

volume_debug() {
    example volume_debug --out $docs/volume-debug.png >$made/volume-debug.txt
}

volume_start() {
    example volume_debug --start $docs/volume-start.png
}

# The picture in the crate's documentation.
picture() {
    [ -n "${SMALL:-}" ] || scripts/picture.sh
}

# Well-known models that are not part of this repository.
models() {
    if [ -z "${MODELS:-}" ]; then
        echo 'models: left out, as MODELS names no directory' >&2
        return 0
    fi
    compare --scene "$MODELS/stanford-bunny.obj" --scene "$MODELS/suzanne.obj" \
        --scene "$MODELS/beetle.obj" --technique volume --frames 2 ${size:-} --out $made/models
    put models $docs/gallery.md <$made/models/scenes.md
}

egui() {
    window=
    if [ -z "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
        window='xvfb-run -a'
        if ! command -v xvfb-run >/dev/null 2>&1; then
            echo 'egui: left out, as there is no display and no xvfb-run' >&2
            return 0
        fi
    fi
    $window cargo run --release --quiet --manifest-path examples/egui/Cargo.toml -- --scene courtyard \
        --technique volumes --show surfaces --screenshot $docs/egui.png
}

# The page in the browser, as its test leaves it.
web() {
    [ -z "${SMALL:-}" ] || return 0
    if ! command -v node >/dev/null 2>&1; then
        echo 'web: left out, as node is not installed' >&2
        return 0
    fi
    rm -f examples/web/target/web-test/wide-layout.png
    scripts/web.sh
    scripts/web.sh test 'wide: layout'
    cp examples/web/target/web-test/wide-layout.png $docs/web.png ||
        echo 'web: left out, as Chromium is not installed' >&2
}

speed_vs_error() {
    compare --sweep --scene courtyard ${swept:-} --frames "${rounds:-8}" ${size:-} \
        --error-at-most 0.001 --time-at-most 40ms --out $made/sweep
    {
        sed '1a\
\
Below: [instructions against error](#instructions-against-error), which no clock has a part in.' \
            $made/sweep/sweep.md
        printf '\n<!-- cost-vs-error -->%s\n\n<!-- /cost-vs-error -->\n' \
            "$(figures cost-vs-error $docs/speed-vs-error.md)"
    } >$made/sweep/page.md
    cp $made/sweep/page.md $docs/speed-vs-error.md
    cp $made/sweep/speed-vs-error.svg $docs/
    sweep_in_words $made/sweep/sweep.md | put speed-vs-error $readme
}

# Counted instructions, of which shader_cost keeps those of one version of Mesa; no times.
cost_vs_error() {
    compare --cost benches/shader_cost/kept/mesa-22.3.6-navi21.json --scene courtyard --scene spheres \
        --scene teapot ${size:-} --out $made/costs-vs-errors
    cp $made/costs-vs-errors/cost-vs-error.svg $docs/
    put cost-vs-error $docs/speed-vs-error.md <$made/costs-vs-errors/cost-vs-error.md
}

growth() {
    compare --growth ${times:-} --frames "${rounds:-16}" --out $docs
}

# Not one case may fail that should pass.
hard_cases() {
    compare --hard-cases --rounds "${hard:-4}" --out $docs
}

temporal() {
    compare --temporal ${tiny:-} --technique all --steps "${steps:-64}" --out $docs
}

benches() {
    runs=${BENCH_RUNS:-3}
    rm -f $made/bench-*.txt
    cargo bench --quiet --no-run
    run=1
    while [ "$run" -le "$runs" ]; do
        started=$(date +%s)
        cargo bench --quiet -- ${quick:-} >$made/bench-$run.txt
        seconds=$(($(date +%s) - started))
        run=$((run + 1))
    done
    ratios $made/bench-1.txt >$made/ratios.txt
    fill_ratios $made/ratios.txt $docs/benches.md
    duration $seconds | put bench-time $docs/benches.md
    adapter=$(sed -n 's/^adapter \(.*\), clock wall$/\1/p' $made/bench-1.txt | head -1)
    echo "$adapter, $(nproc) cores, $(date +%Y-%m-%d)" | put bench-machine $docs/benches.md
    value texels_a_triangle $made/ratios.txt | put texels-a-triangle $docs/benches.md
    for run in $made/bench-*.txt; do ratios "$run"; done | scatter "$runs" | put bench-scatter $docs/benches.md
}

# The deterministic parts, by the debug build that the tests have left, into a directory of their own.
check() {
    profile=
    frames=1
    copies check
    scenes
    kernels
    cheap
    example gallery --day $docs/courtyard-day.png # the others take minutes
    volume_debug
    volume_start
    cost_vs_error
    failed=
    for picture in cheap courtyard courtyard-day difference kernels peers volume-debug volume-start; do
        example same_picture docs/$picture.png $docs/$picture.png || failed="$failed docs/$picture.png"
    done
    same_figures scenes README.md "$readme" || failed="$failed README.md:scenes"
    same_figures courtyard-casters docs/gallery.md "$docs/gallery.md" ||
        failed="$failed docs/gallery.md:courtyard-casters"
    same_figures cost-vs-error docs/speed-vs-error.md "$docs/speed-vs-error.md" ||
        failed="$failed docs/speed-vs-error.md:cost-vs-error"
    if [ -n "$failed" ]; then
        echo "report.sh makes something else now:$failed" >&2
        return 1
    fi
}

# Works on copies from here on.
copies() {
    rm -rf "${made:?}/$1"
    mkdir -p "$made/$1/docs"
    cp docs/*.md "$made/$1/docs/"
    cp README.md "$made/$1/"
    readme=$made/$1/README.md
    docs=$made/$1/docs
}

need_cargo
need_compiler
need_driver
mkdir -p $made

if [ "${1:-}" = --check ]; then
    check
    exit
fi
if [ -n "${SMALL:-}" ]; then
    profile= # the debug build is there already
    copies small
    frames=1 rounds=1 hard=1 steps=2 tiny=32x18 times=1 quick=--quick size='--size 64x36'
    swept='--technique volume,cube-2x2,cube-hard'
    BENCH_RUNS=1
fi
[ $# -gt 0 ] || set -- scenes kernels cheap gallery volume-debug volume-start picture models egui web speed-vs-error \
    cost-vs-error growth hard-cases temporal benches
for part in "$@"; do
    case $part in
    scenes | kernels | cheap | gallery | picture | models | egui | web | growth | temporal | benches) $part ;;
    volume-debug) volume_debug ;;
    volume-start) volume_start ;;
    speed-vs-error) speed_vs_error ;;
    cost-vs-error) cost_vs_error ;;
    hard-cases) hard_cases ;;
    *)
        echo "no part $part; see the head of scripts/report.sh" >&2
        exit 2
        ;;
    esac
done
