#!/usr/bin/env bash
# Sets everything up, builds Release and runs all tests.
#   tests/run.sh [ctest arguments]     for example: tests/run.sh -L cpu, tests/run.sh -R curvature
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source apps/setup.sh
exemplar_install
exemplar_build
export EXEMPLAR_VALIDATION=${EXEMPLAR_VALIDATION:-1}
exec ctest --test-dir "$exemplar_build" --output-on-failure -j "$(nproc)" "$@"
