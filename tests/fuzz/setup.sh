#!/bin/sh
# Installs what coverage-guided fuzzing needs beside this repository, a nightly toolchain and cargo-fuzz,
# and makes a first corpus: random bytes long enough to be whole scenes. It needs a C++ compiler.
# Afterwards, in tests/:
#   cargo +nightly fuzz run bus -- -max_len=4096 -len_control=0 -max_total_time=600
set -eu
cd "$(dirname "$0")"
if ! rustup toolchain list | grep -q '^nightly'; then
    rustup toolchain install nightly --profile minimal
fi
if ! cargo fuzz --version >/dev/null 2>&1; then
    cargo install cargo-fuzz --locked
fi
cargo fuzz --version
mkdir -p corpus/bus
for length in 200 400 800 1600 3200; do
    for number in 1 2 3 4 5 6 7 8; do
        file=corpus/bus/seed-$length-$number
        test -e "$file" || head -c "$length" /dev/urandom >"$file"
    done
done
