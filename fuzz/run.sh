#!/bin/sh
# Fuzzes every target: fuzz/run.sh SECONDS [TARGET...]. Seconds are for each target; 0 runs what is in the corpus once.
# A finding stops the run, and its input is kept in fuzz/findings. Needs a C++ compiler beside Rust (libFuzzer is C++).
set -eu
cd "$(dirname "$0")/.."
seconds=${1:?seconds for each target}
shift
build=${CARGO_TARGET_DIR:-target}/debug
corpus=fuzz/corpus
findings=fuzz/findings

# Compiles the programs named after the features; $1 may set a compiler wrapper.
compile() {
    wrapper=$1 features=$2
    shift 2
    for program in "$@"; do set -- "$@" --bin "fuzz-$program"; shift; done
    RUSTC_WORKSPACE_WRAPPER=$wrapper cargo build --locked -q -p petroglyph-fuzz --features "$features" "$@"
}
instrument=$PWD/fuzz/instrument.sh
compile "" "" seeds
compile "$instrument" libfuzzer segy segy-headers surface
mkdir -p "$findings"
"$build/fuzz-seeds" "$corpus"
case "${*:-documents}" in
    *documents*)
        compile "" documents document-seeds
        compile "$instrument" libfuzzer,documents documents
        "$build/fuzz-document-seeds" "$corpus"
        ;;
esac

[ $# -gt 0 ] || set -- $(ls "$corpus")
total=0
for target in "$@"; do
    program=$target
    FUZZ_FORMAT=
    case $target in
        surface-*) program=surface FUZZ_FORMAT=${target#surface-} ;;
    esac
    export FUZZ_FORMAT
    limit="-max_total_time=$seconds"
    [ "$seconds" -gt 0 ] || limit="-runs=0"
    log="$findings/$target.log"
    if ! "$build/fuzz-$program" "$limit" -timeout=10 -rss_limit_mb=2048 -max_len=16384 -print_final_stats=1 \
        -artifact_prefix="$findings/$target-" "$corpus/$target" >"$log" 2>&1; then
        tail -n 40 "$log" >&2
        echo "fuzzing $target failed; its input is in $findings" >&2
        exit 1
    fi
    inputs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    total=$((total + inputs))
    echo "$target: $inputs inputs"
done
echo "$total inputs, no finding"
