#!/bin/sh
# Fuzzes the readers: fuzz/run.sh SECONDS [TARGET...]. Seconds are for each target; 0 runs what is in the corpus once. The same
# FUZZ_SEED makes up the same inputs; without it they are others each time. Without targets all
# are run. Targets on projects (documents-*, derived-*, model) need most of the program compiled once more; where only others are named it
# is not. A finding stops the run, and its input is kept in fuzz/findings. Needs a C++ compiler beside Rust (libFuzzer is C++).
set -eu
cd "$(dirname "$0")/.."
seconds=${1:?seconds for each target}
shift
build=${CARGO_TARGET_DIR:-target}/debug
corpus=fuzz/corpus
findings=fuzz/findings
# Inputs are small: threads would only wait for one another.
export RAYON_NUM_THREADS=1

# Compiles the programs named after the features, with coverage counters. Features of the whole workspace are united, so
# that crates of others are those of every other build.
compile() {
    features=fuzz/libfuzzer$1
    shift
    for program in "$@"; do set -- "$@" --bin "fuzz-$program"; shift; done
    RUSTC_WORKSPACE_WRAPPER=$PWD/fuzz/instrument.sh CARGO_INCREMENTAL=0 \
        cargo build --locked -q --workspace --features "$features" "$@"
}
# Has a program write the inputs that fuzzing starts from.
seed() {
    FUZZ_SEEDS=$corpus "$build/fuzz-$1" -runs=0 >"$findings/seeds.log" 2>&1 || { cat "$findings/seeds.log" >&2; exit 1; }
}
mkdir -p "$findings"
features=
programs="segy segy-headers surface well"
case " ${*:-documents} " in
    *" documents"* | *" derived"* | *" model"*)
        features=$features,fuzz/documents
        programs="$programs documents derived model" ;;
esac
case " ${*:-tile} " in
    *" tile"* | *" store"*)
        features=$features,fuzz/data
        programs="$programs tile store" ;;
esac
compile "$features" $programs
for program in $programs; do
    case $program in
        segy-headers | surface | well) ;; # `segy` writes theirs
        *) seed "$program" ;;
    esac
done

[ $# -gt 0 ] || set -- $(ls "$corpus")
total=0
for target in "$@"; do
    program=$target
    FUZZ_FORMAT=
    case $target in
        surface-*) program=surface FUZZ_FORMAT=${target#surface-} ;;
        well-*) program=well FUZZ_FORMAT=${target#well-} ;;
        tile-*) program=tile FUZZ_FORMAT=${target#tile-} ;;
        store-*) program=store FUZZ_FORMAT=${target#store-} ;;
        derived-*) program=derived FUZZ_FORMAT=${target#derived-} ;;
        documents-*) program=documents FUZZ_FORMAT=${target#documents-} ;;
    esac
    export FUZZ_FORMAT
    limit="-max_total_time=$seconds"
    [ "$seconds" -gt 0 ] || limit="-runs=0"
    log="$findings/$target.log"
    if ! "$build/fuzz-$program" "$limit" -seed="${FUZZ_SEED:-0}" -timeout=10 -rss_limit_mb=2048 -max_len=16384 -print_final_stats=1 \
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
