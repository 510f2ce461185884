#!/usr/bin/env bash
# Sets everything up, builds Release and runs all tests.
#   tests/run.sh [--browser] [--slurm] [--compare] [ctest arguments]     for example: tests/run.sh -L cpu, tests/run.sh -R curvature
# --browser also installs Chromium and opens a report page in it; --slurm also installs Slurm and GNU parallel and runs a cluster of
# two nodes on this machine; --compare also installs scikit-learn and XGBoost and compares what they learn. Without, those tests are
# skipped.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source apps/setup.sh
packages=()
unset EXEMPLAR_BROWSER EXEMPLAR_SLURM EXEMPLAR_COMPARE
while true; do
    case "${1:-}" in
        --browser)
            packages+=(chromium chromium-driver)
            export EXEMPLAR_BROWSER=1 ;;
        --slurm)
            packages+=(slurm-wlm munge parallel)
            export EXEMPLAR_SLURM=1 ;;
        --compare)
            packages+=(python3-sklearn python3-xgboost python3-matplotlib libopenblas0-pthread)
            export EXEMPLAR_COMPARE=1 ;;
        *) break ;;
    esac
    shift
done
[ -n "${EXEMPLAR_BROWSER:-}" ] ||
    echo "The report page is not opened in a browser (browser.report_page is skipped); --browser asks for that."
[ -n "${EXEMPLAR_SLURM:-}" ] ||
    echo "No Slurm is started (tests labeled slurm are skipped); --slurm asks for that."
[ -n "${EXEMPLAR_COMPARE:-}" ] ||
    echo "Nothing is compared with other learners (tests labeled compare are skipped); --compare asks for that."
exemplar_install "${packages[@]}"
exemplar_build
export EXEMPLAR_VALIDATION=${EXEMPLAR_VALIDATION:-1}
exec ctest --test-dir "$exemplar_build" --output-on-failure -j "$(nproc)" "$@"
