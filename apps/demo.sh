#!/usr/bin/env bash
# Sets everything up, builds Release, then runs the main job on built-in data and writes out/demo/index.html.
#   apps/demo.sh [arguments of 'exemplar demo']     for example: apps/demo.sh --kinds human cup
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source apps/setup.sh
exemplar_install
exemplar_build exemplar exemplar-viewer
exec "$exemplar_build/exemplar" demo --out out/demo "$@"
