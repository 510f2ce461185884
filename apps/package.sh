#!/usr/bin/env bash
# Builds the Debian packages exemplar and exemplar-dev, which run on any processor of this machine's architecture.
#   apps/package.sh [FOLDER]    the folder for them; build-package/packages if not given
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export EXEMPLAR_BUILD=$PWD/build-package
source apps/setup.sh
packages=$(realpath -m "${1:-$exemplar_build/packages}")
exemplar_install dpkg-dev fakeroot
# Pages and changelogs are of the day of the last commit, so that equal sources give equal packages.
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || date +%s)}
export SOURCE_DATE_EPOCH
# -march stays off (see docs/packaging.md); the folders are those of Debian, where libraries lie in one named after the architecture.
log=$(cmake -S . -B "$exemplar_build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DEXEMPLAR_ARCH= \
    -DEXEMPLAR_TESTS=OFF -DEXEMPLAR_BENCH=OFF) || { echo "$log"; exit 1; }
exemplar_build
rm -rf "$packages"/exemplar*.deb
log=$(cpack --config "$exemplar_build/CPackConfig.cmake" -G DEB -B "$packages") || { echo "$log"; exit 1; }
rm -rf "$packages/_CPack_Packages"
ls "$packages"/exemplar*.deb
