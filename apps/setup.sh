# Sourced by apps/demo.sh, tests/run.sh and .ci/lint. Defines how to install missing packages and how to configure and
# build, as Release unless the build folder says otherwise; sets XDG_RUNTIME_DIR where it is not set.
# shellcheck shell=bash

exemplar_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
exemplar_build=${EXEMPLAR_BUILD:-$exemplar_root/build}

exemplar_packages() { sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$exemplar_root/apps/packages.txt"; }

exemplar_missing_packages() {
    local name
    for name in $(exemplar_packages) "$@"; do
        dpkg-query -W -f '${Status}' "$name" 2>/dev/null | grep -q 'ok installed' || echo "$name"
    done
}

# Installs what is missing on Debian and its relatives; elsewhere prints the list and lets CMake find what is there.
exemplar_install() {
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        echo "This is no Debian system. Exemplar needs what Debian calls:" $(exemplar_packages) "$@"
        return 0
    fi
    local missing as_root=()
    missing=$(exemplar_missing_packages "$@")
    [ -n "$missing" ] || return 0
    echo "Installing Debian packages:" $missing
    if [ "$(id -u)" != 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "error: not root and no sudo: install the packages above as root, then call this again" >&2
            return 1
        fi
        as_root=(sudo)
    fi
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive sh -c \
        'apt-get -qq update && apt-get -qq install -y --no-install-recommends "$@" >/dev/null' install $missing
}

# Builds the targets named, or everything.
exemplar_build() {
    local first=() log
    if [ ! -e "$exemplar_build/CMakeCache.txt" ]; then
        first=(-G Ninja -DCMAKE_BUILD_TYPE=Release)
        echo "Building in $exemplar_build; the first time takes some minutes."
    fi
    log=$(cmake -S "$exemplar_root" -B "$exemplar_build" "${first[@]}") || { echo "$log"; return 1; }
    cmake --build "$exemplar_build" --target "${@:-all}"
}

# Vulkan's software driver needs a private folder for its sockets; all runs share one of the user's.
if [ -z "${XDG_RUNTIME_DIR:-}" ]; then
    XDG_RUNTIME_DIR=${TMPDIR:-/tmp}/exemplar-$(id -u)
    mkdir -m 700 "$XDG_RUNTIME_DIR" 2>/dev/null || [ -O "$XDG_RUNTIME_DIR" ] || XDG_RUNTIME_DIR=$(mktemp -d)
    export XDG_RUNTIME_DIR
fi
