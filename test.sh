#!/bin/sh
# Sets up, builds and tests: every test but those labelled `long` or `fuzz`; --all adds the long ones, --fuzz runs a
# minute of each fuzz target alone (and skips them where there is no clang). Ends with ctest's closing line and status.
# With CI=true in the environment warnings are errors.
set -eu
cd "$(dirname "$0")"

usage() {
    echo "usage: ./test.sh [--all | --fuzz]" >&2
    exit 64
}
selection="--label-exclude ^(long|fuzz)\$"
case "$#:${1-}" in
    0:) ;;
    1:--all) selection="--label-exclude ^fuzz\$" ;;
    1:--fuzz) selection="--label-regex ^fuzz\$ --verbose" ;;
    *) usage ;;
esac
warnings_are_errors=OFF
[ "${CI-}" != true ] || warnings_are_errors=ON

./.ci/build.sh -DPENUMBRA_TESTS=ON -DPENUMBRA_BENCHMARKS=ON -DPENUMBRA_WERROR=$warnings_are_errors
# No test at all would be a broken build, not a success. $selection is meant to split.
exec ctest --test-dir build/release --output-on-failure --no-tests=error -j "$(nproc)" $selection
