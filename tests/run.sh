#!/usr/bin/env bash
# Sets everything up, builds Release and runs all tests.
#   tests/run.sh [--browser] [ctest arguments]     for example: tests/run.sh -L cpu, tests/run.sh -R curvature
# --browser also installs Chromium and opens a report page in it; without, that test is skipped.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source apps/setup.sh
browser=()
if [ "${1:-}" = --browser ]; then
    shift
    browser=(chromium chromium-driver)
    export EXEMPLAR_BROWSER=1
else
    unset EXEMPLAR_BROWSER
    echo "The report page is not opened in a browser (browser.report_page is skipped); --browser asks for that."
fi
exemplar_install "${browser[@]}"
exemplar_build
export EXEMPLAR_VALIDATION=${EXEMPLAR_VALIDATION:-1}
exec ctest --test-dir "$exemplar_build" --output-on-failure -j "$(nproc)" "$@"
