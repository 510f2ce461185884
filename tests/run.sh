#!/usr/bin/env bash
# Sets everything up, builds Release and runs all tests.
#   tests/run.sh [OPTION...] [ctest arguments]     for example: tests/run.sh -L cpu, tests/run.sh -R curvature
# Without these options, what they ask for is skipped:
#   --browser      also installs Chromium and opens a report page in it
#   --slurm        also installs Slurm and GNU parallel and runs a cluster of two nodes on this machine
#   --swiftshader  runs the tests of kernels a second time, on the SwiftShader that comes with Debian's Chromium: a driver with
#                  the least that Vulkan asks for
#   --card         runs the tests of kernels a second time as on a graphics card: device memory that the host does not see, the
#                  kernels for cards, none replaced by the host, fresh memory full of NaN
#   --package      also builds the Debian packages and installs them into a Debian of their own (as root)
#   --compare      also installs scikit-learn, XGBoost and PyTorch and compares what they learn
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source apps/setup.sh
packages=()
swiftshader=
card=
unset EXEMPLAR_BROWSER EXEMPLAR_SLURM EXEMPLAR_PACKAGES EXEMPLAR_COMPARE
while true; do
    case "${1:-}" in
        --browser)
            packages+=(chromium chromium-driver)
            export EXEMPLAR_BROWSER=1 ;;
        --slurm)
            packages+=(slurm-wlm munge parallel)
            export EXEMPLAR_SLURM=1 ;;
        --swiftshader)
            packages+=(chromium)
            swiftshader=1 ;;
        --card)
            card=1 ;;
        --package)
            packages+=(debootstrap lintian)
            export EXEMPLAR_PACKAGES=$PWD/build-package/packages ;;
        --compare)
            packages+=(python3-sklearn python3-xgboost python3-torch python3-matplotlib libopenblas0-pthread)
            export EXEMPLAR_COMPARE=1 ;;
        *) break ;;
    esac
    shift
done
[ -n "${EXEMPLAR_BROWSER:-}" ] ||
    echo "The report page is not opened in a browser (browser.report_page is skipped); --browser asks for that."
[ -n "${EXEMPLAR_SLURM:-}" ] ||
    echo "No Slurm is started (tests labeled slurm are skipped); --slurm asks for that."
[ -n "${EXEMPLAR_PACKAGES:-}" ] ||
    echo "No Debian package is built and installed (package.debian is skipped); --package asks for that."
[ -n "${EXEMPLAR_COMPARE:-}" ] ||
    echo "Nothing is compared with other learners (tests labeled compare are skipped); --compare asks for that."
exemplar_install "${packages[@]}"
exemplar_build
[ -z "${EXEMPLAR_PACKAGES:-}" ] || apps/package.sh "$EXEMPLAR_PACKAGES"
export EXEMPLAR_VALIDATION=${EXEMPLAR_VALIDATION:-1}
ctest --test-dir "$exemplar_build" --output-on-failure -j "$(nproc)" "$@"
if [ -n "$card" ]; then
    echo "The tests of kernels again, as on a graphics card"
    (
        export EXEMPLAR_MEMORY=unmapped EXEMPLAR_HOST=never EXEMPLAR_KERNELS=card EXEMPLAR_POISON=1
        ctest --test-dir "$exemplar_build" --output-on-failure -j "$(nproc)" -R '^(gpu\.|parity\.|window\.|apps\.labeling$|apps\.lines$)'
    )
fi
if [ -n "$swiftshader" ]; then
    echo "The tests of kernels again, on SwiftShader"
    export VK_ICD_FILENAMES=/usr/lib/chromium/vk_swiftshader_icd.json
    # By whole programs, a part of each to every core: this driver compiles all kernels anew in each process.
    GTEST_TOTAL_SHARDS=$(nproc)
    export GTEST_TOTAL_SHARDS exemplar_build
    for name in gpu window bench parity; do
        seq 0 $((GTEST_TOTAL_SHARDS - 1)) | xargs -P "$GTEST_TOTAL_SHARDS" -I% \
            env GTEST_SHARD_INDEX=% "$exemplar_build/tests/test_$name" --gtest_brief=1
    done
fi
