#!/bin/bash
# What gpu.sh packed, run on the machine that has the GPU:
#
#   run.sh OUT [SECONDS [PART...]]      all parts, within 520 seconds
#
# Parts, in this order: `tests` (depth_planes first), `hard` cases, `temporal`: beside each other, a few
# processes a time; then alone, since they measure time: `scenes`, `sweep`, `benches`. `tests/NAME`
# is one suite. A part that fails, hangs or is cut off does not stop the others. OUT gets, anew whenever
# something has ended:
#
#   summary.txt        a line for each suite, and why which tests failed
#   failures.txt       all that failing suites said
#   reports.tar.gz     reports, small pictures and logs
#
# SHADOWS_TEST_ADAPTER is a part of the name of the adapter to take, where there are several.
set -u
root=$(cd "$(dirname "$0")" && pwd)
out=${1:?run.sh OUT [SECONDS [PART...]]}
budget=${2:-520}
shift $(($# < 2 ? $# : 2))

# `BINARY SUITE` for each: a whole binary, or each module of those that are about more than one thing.
suites() {
    local binary
    for binary in "$root"/deps/*; do
        binary=${binary##*/}
        case $binary in
        maps | receivers | measured)
            "$root/deps/$binary" --list --format terse 2>/dev/null | sed -n "s/::.*: test$//p" | sort -u |
                sed "s/^/$binary /"
            ;;
        *) echo "$binary $binary" ;;
        esac
    done
}

parts=" ${*:-tests hard temporal scenes sweep benches} "
for part in $parts; do
    case $part in
    tests | hard | temporal | scenes | sweep | benches) ;;
    *)
        if [ "$part" = "${part#tests/}" ] || ! suites | grep -q " ${part#tests/}$"; then
            echo "no part $part; see the head of gpu_run.sh" >&2
            exit 2
        fi
        ;;
    esac
done
mkdir -p "$out"
out=$(cd "$out" && pwd)
work=$root/work
logs=$work/logs
rm -rf "$work"
mkdir -p "$logs" "$work/reports" "$work/tmp" "$work/cache" "$work/runtime" "$work/home"
chmod 700 "$work/runtime"
cores=$(nproc)
SECONDS=0

# Drivers keep what they compiled, so that not each of many processes compiles it. (NVIDIA's keeps nothing for
# root unless told to.)
export HOME=$work/home TMPDIR=$work/tmp XDG_RUNTIME_DIR=$work/runtime XDG_CACHE_HOME=$work/cache
export __GL_SHADER_DISK_CACHE=1 __GL_SHADER_DISK_CACHE_PATH=$work/cache __GL_SHADER_DISK_CACHE_SKIP_CLEANUP=1
export SHADOWS_REQUIRE_GPU=1 RUST_BACKTRACE=0 RAYON_NUM_THREADS=$((cores < 4 ? cores : 4))

compare=$root/examples/compare
wanted=()
[ -z "${SHADOWS_TEST_ADAPTER:-}" ] || wanted=(--adapter "$SHADOWS_TEST_ADAPTER")

# --- A driver ---------------------------------------------------------------------------------------------

# The adapters that are found: what `compare` says when none has the name.
adapters() {
    timeout 60 "$compare" --adapter 'no such adapter' --out "$work/none" 2>&1 |
        sed -n 's/.*there are: //p'
}

manifest() {
    printf '{"file_format_version":"1.0.0","ICD":{"library_path":"%s","api_version":"1.3.0"}}\n' "$1" >"$2"
}

# Where NVIDIA's driver lies: a manifest that nobody installed, or a library without one. The EGL one needs
# no X11.
nvidia() {
    local library name
    ls /usr/local/nvidia/share/vulkan/icd.d/nvidia_icd.json 2>/dev/null
    for name in libGLX_nvidia.so.0 libEGL_nvidia.so.0; do
        library=$( { ldconfig -p | sed -n "s|.*$name .*x86-64.* => ||p"
            ls /usr/local/nvidia/lib64/$name /usr/lib/x86_64-linux-gnu/$name /usr/lib64/$name; } 2>/dev/null |
            head -n 1)
        [ -n "$library" ] || continue
        manifest "$library" "$work/$name.json"
        echo "$work/$name.json"
    done
}

is_software() {
    case $1 in '' | *llvmpipe* | *SwiftShader*) return 0 ;; esac
    return 1
}

find_driver() {
    local icd found
    if ! ldconfig -p 2>/dev/null | grep -q 'libvulkan\.so\.1 '; then
        export LD_LIBRARY_PATH=$root/loader${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
        driver="its own loader"
    fi
    found=$(adapters)
    # Whoever asks for an adapter or a driver gets that; a software driver is no answer where there may be a GPU.
    if [ -z "${SHADOWS_TEST_ADAPTER:-}${VK_DRIVER_FILES:-}" ] && is_software "$found"; then
        local before=${LD_LIBRARY_PATH:-}
        for icd in $(nvidia); do
            export VK_DRIVER_FILES=$icd
            [ ! -d /usr/local/nvidia/lib64 ] || export LD_LIBRARY_PATH=$before${before:+:}/usr/local/nvidia/lib64
            local other
            other=$(adapters)
            if ! is_software "$other"; then
                found=$other
                driver="$driver${driver:+, }$icd"
                break
            fi
            unset VK_DRIVER_FILES
            export LD_LIBRARY_PATH=$before
        done
    fi
    adapter=$found
}

# --- Suites -----------------------------------------------------------------------------------------------

# Seconds that are left until a time.
left() { echo $(($1 - SECONDS)); }

# Runs a command for so long at most, into a log of its name; leaves how it ended and how long it took.
suite() {
    local name=$1 limit=$2 from=$SECONDS
    shift 2
    timeout -k 5 "$limit" "$@" >"$logs/$name.log" 2>&1 </dev/null
    echo "$? $((SECONDS - from)) $limit" >"$logs/$name.tmp"
    mv "$logs/$name.tmp" "$logs/$name.end"
}

passed() { grep -Ec '^test .* \.\.\. ok$' "$logs/$1.log"; }
failed() { sed -En 's/^test (.*) \.\.\. FAILED$/\1/p' "$logs/$1.log"; }

# A suite's line, and the tests of it that did not pass with what they said.
report() {
    local name=$1 code seconds limit ended test said
    read -r code seconds limit <"$logs/$name.end"
    case $code in
    0) ended=ok ;;
    124 | 137) ended="CUT OFF after $limit s" ;;
    *) ended="FAILED, exit $code" ;;
    esac
    if [ -e "$logs/$name.tests" ]; then
        ended="$ended: $(passed "$name") of $(wc -l <"$logs/$name.tests") tests passed"
        said=$(grep -c '^skipped: ' "$logs/$name.log")
        [ "$said" -eq 0 ] || ended="$ended, $said said 'skipped'"
    fi
    printf '%-26s %4d s  %s\n' "$name" "$seconds" "$ended"
    [ "$code" != 0 ] || return
    if [ ! -e "$logs/$name.tests" ]; then
        tail -n 4 "$logs/$name.log" | cut -c 1-300 | sed 's/^/    /'
        return
    fi
    while read -r test; do
        if failed "$name" | grep -qxF "$test"; then
            echo "    failed: $test"
            why "$test" <"$logs/$name.log" | head -n 8 | cut -c 1-300 | sed 's/^/        /'
        elif ! grep -qxF "test $test ... ok" "$logs/$name.log"; then
            echo "    did not end: $test"
        fi
    done <"$logs/$name.tests"
}

# What a test's panic said: libtest names a test's thread by it.
why() {
    awk -v start="thread '$1' " '
        index($0, start) == 1 && / panicked at / { inside = 1; sub(/.* panicked at /, "at "); print; next }
        /^(test |note: run with|thread )/ { inside = 0 }
        inside && NF { print }'
}

publish() {
    local name
    {
        echo "shadows $(cat "$root/version")"
        echo "$(date -u '+%Y-%m-%d %H:%M') UTC, $cores cores, $SECONDS of $budget s; $(uname -sr)"
        echo "adapters: ${adapter:-none}${driver:+ ($driver)}"
        ! command -v nvidia-smi >/dev/null ||
            nvidia-smi --query-gpu=name,driver_version,clocks.sm,clocks.mem --format=csv,noheader 2>/dev/null
        echo
        cat "$work/lines" 2>/dev/null
        [ -z "${1:-}" ] || echo "$1"
    } >"$out/summary.tmp"
    mv "$out/summary.tmp" "$out/summary.txt"
    for name in $bad; do
        echo "======== $name"
        cat "$logs/$name.log"
    done >"$out/failures.txt"
    # Large pictures stay here.
    (cd "$work" && find logs reports -type f ! -name '*.end' ! -size +200k -print0 |
        tar --null -T - -czf "$out/reports.tmp" && mv "$out/reports.tmp" "$out/reports.tar.gz")
}

bad= ended_all=true
done_with() {
    local name=$1
    report "$name" | tee -a "$work/lines"
    case $(cat "$logs/$name.end") in '0 '*) ;; *) bad="$bad $name" ;; esac
}

not_started() {
    printf '%-26s    -    NOT STARTED\n' "$1" | tee -a "$work/lines"
    ended_all=false
}

# --- Many at a time ---------------------------------------------------------------------------------------

queue=() # "WHEN NAME LIMIT", the command in NAME.command

# WHEN, from 0 to 1, says what is run before what.
enqueue() {
    local when=$1 name=$2 limit=$3
    shift 3
    printf '%s\n' "$@" >"$logs/$name.command"
    queue+=("$when $name $limit")
}

# A suite of a test binary in processes of at most 8 tests: in one, a driver may compile for one thread at a
# time. Those of a large suite are spread among the others.
enqueue_tests() {
    local binary=$1 name=$2 most=8 all=$work/all.tests own=. shards shard file when
    shift 2
    [ "$binary" = "$name" ] || own="^$name::"
    "$root/deps/$binary" --list --format terse 2>/dev/null | sed -n 's/: test$//p' | grep "$own" |
        { [ $# -eq 0 ] && cat || grep -vxF "$@"; } >"$all"
    shards=$((($(wc -l <"$all") + most - 1) / most))
    for ((shard = 1; shard <= shards; shard++)); do
        local part=$name
        [ "$shards" -eq 1 ] || part=$name-$shard
        file=$logs/$part.tests
        when=$(awk -v a="$shard" -v b="$shards" 'BEGIN { print (a - 0.5) / b }')
        [ "$name" != depth_planes ] || when=0
        # Neighbours are alike, and alike in what they cost.
        awk -v shards="$shards" -v shard="$shard" 'NR % shards == shard % shards' "$all" >"$file"
        enqueue "$when" "$part" 150 "$root/deps/$binary" --exact --nocapture --test-threads 2 $(cat "$file")
    done
}

# Runs what is queued, so many processes at a time, until a time.
drain() {
    local slots=$1 until=$2 running=() next=0 name limit still command
    mapfile -t queue < <(printf '%s\n' "${queue[@]}" | sort -s -n -k 1,1)
    while [ "$next" -lt "${#queue[@]}" ] || [ "${#running[@]}" -gt 0 ]; do
        while [ "$next" -lt "${#queue[@]}" ] && [ "${#running[@]}" -lt "$slots" ] && [ "$(left "$until")" -ge 5 ]; do
            read -r _ name limit <<<"${queue[$next]}"
            next=$((next + 1))
            [ "$limit" -le "$(left "$until")" ] || limit=$(left "$until")
            mapfile -t command <"$logs/$name.command"
            suite "$name" "$limit" "${command[@]}" &
            running+=("$name")
        done
        if [ "${#running[@]}" -eq 0 ]; then # no time for what is left
            while [ "$next" -lt "${#queue[@]}" ]; do
                read -r _ name limit <<<"${queue[$next]}"
                not_started "$name"
                next=$((next + 1))
            done
            break
        fi
        wait -n
        still=()
        for name in "${running[@]}"; do
            if [ -e "$logs/$name.end" ]; then
                done_with "$name"
            else
                still+=("$name")
            fi
        done
        running=("${still[@]+"${still[@]}"}")
        publish
    done
    queue=()
}

alone() {
    local name=$1 limit=$2
    shift 2
    [ "$limit" -le "$(left "$budget")" ] || limit=$(left "$budget")
    if [ "$limit" -lt 5 ]; then
        not_started "$name"
        return
    fi
    suite "$name" "$limit" "$@"
    done_with "$name"
    publish
}

asked() { case $parts in *" $1 "*) return 0 ;; esac; return 1; }

# --- The run ----------------------------------------------------------------------------------------------

driver= adapter=
find_driver
publish
head -n 4 "$out/summary.txt"
if [ -z "$adapter" ]; then
    echo 'No adapter: a Vulkan driver is missing, or its manifest.' | tee -a "$out/summary.txt" >&2
    exit 1
fi

! asked hard || enqueue 0.01 compare-hard-cases 200 \
    "$compare" --hard-cases --rounds 1 "${wanted[@]+"${wanted[@]}"}" --out "$work/reports/hard-cases"
while read -r binary name; do
    asked tests || asked "tests/$name" || continue
    case $name in
    # What `compare` does as well.
    hard_cases) enqueue_tests "$binary" hard_cases -e hard_cases::one_round_passes ;;
    *) enqueue_tests "$binary" "$name" ;;
    esac
done < <(suites)
! asked temporal || enqueue 0.4 compare-temporal 120 \
    "$compare" --temporal --technique all --steps 16 "${wanted[@]+"${wanted[@]}"}" --out "$work/reports/temporal"
# A thread of a test and one of its driver for each core. What is measured gets two fifths of the time.
timed=0
if asked scenes || asked sweep || asked benches; then timed=$((budget * 2 / 5)); fi
[ "${#queue[@]}" -eq 0 ] || drain $((cores < 4 ? 1 : cores / 2)) $((budget - timed))

export RAYON_NUM_THREADS=$cores
! asked scenes || alone compare-scenes 120 "$compare" --scene spheres --scene courtyard --scene teapot \
    --technique all --frames 8 "${wanted[@]+"${wanted[@]}"}" --out "$work/reports/scenes"
! asked sweep || alone compare-sweep 150 "$compare" --sweep --scene courtyard --frames 8 \
    "${wanted[@]+"${wanted[@]}"}" --out "$work/reports/sweep"
if asked benches; then
    for bench in shadow_volume cube_map pcf operations adjacency; do
        alone "bench-$bench" 90 "$root/benches/$bench" --bench --quick
        grep -E '^(adapter|ratio) ' "$logs/bench-$bench.log" >"$work/reports/bench-$bench.txt" 2>/dev/null
    done
fi
publish "done in $SECONDS s"
echo "done in $SECONDS s, see $out"
[ -z "$bad" ] && $ended_all
