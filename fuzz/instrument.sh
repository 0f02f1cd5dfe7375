#!/bin/sh
# Compiles our own crates with the coverage counters that libFuzzer steers by. Cargo calls it as RUSTC_WORKSPACE_WRAPPER,
# so dependencies are the ones of every other build. These flags are LLVM's and need no nightly compiler. Comparisons are not traced:
# in loops over samples that takes nine tenths of the time, and the seeds hold the words that formats are known by.
# Inputs are small, so optimising the program takes longer than what it saves.
exec "$@" \
    -Copt-level=1 \
    -Cpasses=sancov-module \
    -Cllvm-args=-sanitizer-coverage-level=3 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters \
    -Cllvm-args=-sanitizer-coverage-pc-table
