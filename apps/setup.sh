# Sourced by apps/demo.sh and tests/run.sh: makes sure that the packages are there, then configures and builds Release.
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

exemplar_build() {
    local generator=()
    [ -e "$exemplar_build/CMakeCache.txt" ] || generator=(-G Ninja)
    cmake -S "$exemplar_root" -B "$exemplar_build" "${generator[@]}" -DCMAKE_BUILD_TYPE=Release "$@" >"${TMPDIR:-/tmp}/exemplar-cmake.$$" ||
        { cat "${TMPDIR:-/tmp}/exemplar-cmake.$$"; return 1; }
    rm -f "${TMPDIR:-/tmp}/exemplar-cmake.$$"
    cmake --build "$exemplar_build"
}

# Vulkan's software driver wants a private folder for its sockets.
if [ -z "${XDG_RUNTIME_DIR:-}" ]; then
    XDG_RUNTIME_DIR=$(mktemp -d)
    chmod 700 "$XDG_RUNTIME_DIR"
    export XDG_RUNTIME_DIR
fi
