#!/usr/bin/env bash
# Builds the X.Org module and tests it with a real server.
#
#   ddx-shim/test.sh build    builds target/release/zga_drv.so and the suites
#   ddx-shim/test.sh quick    builds, and what takes a few minutes; for every change
#   ddx-shim/test.sh full     builds, and everything but the soak; for a release
#   ddx-shim/test.sh soak     builds, and an hour of everything mixed (SECONDS_OF_SOAK)
#   ddx-shim/test.sh null     builds the suites, and tests them: the reference against itself, and with planted faults
#   ddx-shim/test.sh COMMAND  builds, and one command of the suites, for example: test.sh differential --seed 7 --seeds 1
#
# Exit code 0 if all held, 1 if something did not, 2 if it could not be tested. Pictures and logs: zga-out/x.
set -uo pipefail
cd "$(dirname "$0")/.."

target=${CARGO_TARGET_DIR:-target}
suite=$target/release/examples/x_suite
worst=0

step() { printf '\n== %s\n' "$*"; }

# Runs a suite and goes on; what failed is told at the end.
failed=()
run() {
  step "x_suite $*"
  "$suite" "$@"
  local code=$?
  if [ $code -ne 0 ]; then
    failed+=("x_suite $*")
    [ $code -gt $worst ] && worst=$code
  fi
}

build() {
  step "the module and the suites"
  # In one go with the program: both then have the card built with the same effects.
  cargo build --release --locked -p zga-demos -p zga-ddx-shim --features zga-ddx-shim/xorg --lib --bins --example x_suite --example pixman || exit 2
  # A build without the feature makes a library of the same name that is no module: the module gets a name of its own.
  # Moved into its place, not written over: a server may have the one before in its memory.
  cp "$target/release/libzga_ddx_shim.so" "$target/release/zga_drv.so.new" || exit 2
  mv "$target/release/zga_drv.so.new" "$target/release/zga_drv.so" || exit 2
}

suites() {
  step "the suites"
  cargo build --release --locked -p zga-ddx-shim --example x_suite || exit 2
}

null() {
  run differential --driver dummy --seeds "$1"
  run differential --driver dummy --seeds "$1" --render
  run differential --driver dummy --seeds "$1" --depth 16
  run mutants --driver dummy --seeds 20
  run mutants --driver dummy --seeds 20 --render
}

# The card's compositions against libpixman: with all its ways, and with the general one alone.
pixman() {
  local off
  for off in "" "fast mmx sse2 ssse3 wholeops"; do
    step "pixman --cases $1${off:+, without $off}"
    if ! PIXMAN_DISABLE=$off "$target/release/examples/pixman" --cases "$1"; then
      failed+=("pixman --cases $1${off:+, without $off}")
      [ $worst -lt 1 ] && worst=1
    fi
  done
}

# What a user types, at both depths.
program() {
  local out=zga-out/x/program.png depth
  for depth in 24 16; do
    step "zga x --depth $depth, with a client that ends by itself"
    rm -f "$out"
    if ! "$target/release/zga" x --depth $depth --size 640x480 --seconds 3 --out "$out" --stats -- \
      xterm -e 'seq 1 500; sleep 60' || [ ! -s "$out" ]; then
      failed+=("zga x --depth $depth")
      [ $worst -lt 1 ] && worst=1
    fi
  done
}

quick() {
  null 10
  pixman 30000
  run differential --seeds 30
  # By itself the module leaves small work to the server while the card is idle: here the card draws all that it can.
  run differential --seeds 60 --cpu-limit 0
  run differential --seeds 30 --cpu-limit 0 --render
  run differential --seeds 20 --cpu-limit 0 --depth 16 --render
  run differential --seeds 20 --cpu-limit 0 --memory 5 --pressure --render
  run differential --seeds 20 --cpu-limit 0 --composite --render
  run rendercheck --quick --cpu-limit 0
  run kills --clients 6
  program
}

full() {
  null 50
  pixman 1000000
  local limit
  for limit in 0 32768; do
    run differential --seeds 200 --cpu-limit $limit
    run differential --seeds 200 --seed 1001 --cpu-limit $limit --render
    run differential --seeds 200 --seed 2001 --cpu-limit $limit --depth 16
    run differential --seeds 100 --seed 3001 --cpu-limit $limit --depth 16 --render
    run differential --seeds 100 --seed 4001 --cpu-limit $limit --memory 4 --pressure
    run differential --seeds 100 --seed 5001 --cpu-limit $limit --memory 5 --pressure --render
    run differential --seeds 100 --seed 6001 --cpu-limit $limit --composite
    run differential --seeds 100 --seed 7001 --cpu-limit $limit --composite --render
  done
  run differential --seeds 50 --seed 8001 --no-accel --render
  run rendercheck --beside --cpu-limit 0
  run rendercheck --depth 16 --quick --cpu-limit 0
  run clients
  run kills
  run soak --seconds 300
  program
  run perf
}

case "${1:-quick}" in
  build) build ;;
  quick) build && quick ;;
  full) build && full ;;
  soak) build && run soak --seconds "${SECONDS_OF_SOAK:-3600}" ;;
  null) suites && null 50 ;;
  *) build && run "$@" ;;
esac

if [ ${#failed[@]} -gt 0 ]; then
  step "did not hold"
  printf '%s\n' "${failed[@]}"
fi
exit $worst
