#!/usr/bin/env bash
# Sets everything up, builds Release, then runs the main job on built-in data and writes out/demo/index.html; then builds the programs.
#   apps/demo.sh [arguments of 'exemplar demo']     for example: apps/demo.sh --kinds human cup
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source apps/setup.sh
exemplar_install
exemplar_build exemplar-demo
"$exemplar_build/exemplar-demo" demo --out out/demo "$@"
echo "Building the programs $exemplar_build/exemplar and exemplar-viewer; the page does not need them, so Ctrl-C does no harm"
exemplar_build exemplar exemplar-viewer
