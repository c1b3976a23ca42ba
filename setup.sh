#!/usr/bin/env bash
# Installs what moire needs beside Rust, and nothing twice:
#   run time   the Vulkan loader and Mesa's lavapipe (a CPU driver: no GPU needed)
#   tests      the Khronos validation layer
#   build      a C++ compiler and, where the distribution has them, the shader compiler's archives
# and merges those archives into .cargo/shaderc/libshaderc_combined.a, where .cargo/config.toml
# points the crate shaderc-sys. Where they are missing or do not link, the crate builds shaderc from
# source by itself (about 10 minutes; needs cmake, git and python3 too).
# Quiet when nothing is missing. MOIRE_SETUP_DRY_RUN=1 prints what would be installed and stops.
# MOIRE_SETUP_PYTHON=1 adds what the module of Python is built with.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
HOME=${HOME:-~} # of the user who runs this, where the environment has none

RUN_PACKAGES="libvulkan1 mesa-vulkan-drivers"
TEST_PACKAGES="vulkan-validationlayers"
BUILD_PACKAGES="g++"
ARCHIVE_PACKAGES="libshaderc-dev glslang-dev spirv-tools"
SOURCE_PACKAGES="cmake git python3"
PYTHON_PACKAGES="python3 python3-venv"
MIN_CARGO="1.88"

say() { printf 'setup: %s\n' "$*" >&2; }

version_at_least() { # version_at_least HAVE WANT
    [ "$(printf '%s\n%s\n' "$2" "$1" | sort -V | head -n 1)" = "$2" ]
}

check_cargo() {
    local paths="${CARGO_HOME:-$HOME/.cargo}/env"
    # shellcheck disable=SC1090
    if [ -f "$paths" ]; then . "$paths"; fi
    local have=""
    if command -v cargo >/dev/null; then have=$(cargo --version | cut -d' ' -f2); fi
    if [ -z "$have" ] || ! version_at_least "$have" "$MIN_CARGO"; then
        say "cargo ${have:-is not installed}; moire needs $MIN_CARGO or newer (edition 2024)."
        say "Install Rust with rustup (https://rustup.rs), or update it with: rustup update stable"
        exit 1
    fi
}

installed() { dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q 'ok installed'; }

missing_of() {
    local p
    for p in "$@"; do installed "$p" || printf '%s ' "$p"; done
}

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

can_install() { [ "$(id -u)" = 0 ] || command -v sudo >/dev/null; }

apt_install() { # apt_install PACKAGES...
    if ! can_install; then
        say "not root and no sudo; run as root: apt-get install $*"
        return 1
    fi
    say "installing $*"
    if [ -z "$(find /var/lib/apt/lists -maxdepth 1 -name '*_Packages*' -mtime -1 -print -quit 2>/dev/null)" ]; then
        as_root apt-get update -qq
    fi
    local install="env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends"
    # Lists of yesterday may name files that are gone: once more with new ones.
    # shellcheck disable=SC2086
    as_root $install "$@" >/dev/null || { as_root apt-get update -qq && as_root $install "$@" >/dev/null; }
}

# Does a program that uses the compiler link against this archive?
links() { # links ARCHIVE
    local program
    program=$(mktemp)
    printf '%s\n' 'extern "C" { void* shaderc_compiler_initialize(void); void shaderc_compiler_release(void*);' \
        'void* shaderc_compile_into_spv(void*, const char*, unsigned long, int, const char*, const char*, void*); }' \
        'int main() { void* c = shaderc_compiler_initialize();' \
        'shaderc_compile_into_spv(c, "", 0, 2, "", "main", 0); shaderc_compiler_release(c); }' |
        g++ -x c++ - -x none "$1" -pthread -o "$program" 2>/dev/null
    local status=$?
    rm -f "$program"
    return $status
}

# One archive from those that the distribution has; 1 when the compiler itself is not among them.
merge_shaderc() {
    local out=.cargo/shaderc/libshaderc_combined.a dir="" d lib found=0 tmp
    for d in "/usr/lib/$(uname -m)-linux-gnu" /usr/lib64 /usr/lib; do
        if [ -f "$d/libshaderc.a" ] || [ -f "$d/libshaderc_combined.a" ]; then dir=$d; break; fi
    done
    [ -n "$dir" ] || { rm -f "$out"; return 1; }
    [ -f "$out" ] && [ "$out" -nt "$dir/libshaderc_combined.a" ] && return 0
    mkdir -p .cargo/shaderc
    tmp=$(mktemp -d)
    # ar's scripts know no quotes: it works where the file is to lie, whatever the folder's name.
    {
        echo "create libshaderc_combined.a"
        for lib in libshaderc_combined libshaderc libshaderc_util libglslang libSPIRV libMachineIndependent \
            libGenericCodeGen libOSDependent libOGLCompiler libHLSL libSPIRV-Tools-opt libSPIRV-Tools; do
            # libshaderc_combined already holds libshaderc and libshaderc_util.
            case $lib in libshaderc|libshaderc_util) [ "$found" = 1 ] && continue ;; esac
            if [ -f "$dir/$lib.a" ]; then
                echo "addlib $dir/$lib.a"
                [ "$lib" = libshaderc_combined ] && found=1
            fi
        done
        echo save
        echo end
    } >"$tmp/merge.mri"
    if ! (cd "$tmp" && ar -M <merge.mri) || ! links "$tmp/libshaderc_combined.a"; then
        rm -rf "$tmp" "$out"
        return 1
    fi
    mv "$tmp/libshaderc_combined.a" "$out"
    rm -r "$tmp"
    say "merged the shader compiler's archives into $out"
}

check_cargo
if [ "${MOIRE_SETUP_PYTHON:-0}" = 1 ]; then BUILD_PACKAGES="$BUILD_PACKAGES $PYTHON_PACKAGES"; fi
if command -v apt-get >/dev/null && command -v dpkg-query >/dev/null; then
    # shellcheck disable=SC2086 # the lists are words on purpose
    missing=$(missing_of $RUN_PACKAGES $TEST_PACKAGES $BUILD_PACKAGES)
    # shellcheck disable=SC2086
    archives=$(missing_of $ARCHIVE_PACKAGES)
    if [ "${MOIRE_SETUP_DRY_RUN:-0}" = 1 ]; then
        missing=$missing$archives
        say "would install: ${missing:-nothing}"
        exit 0
    fi
    if [ -n "$missing" ]; then
        # Who has to ask for them asks once.
        can_install || missing=$missing$archives
        # shellcheck disable=SC2086
        apt_install $missing
    fi
    if [ -n "$archives" ]; then
        # shellcheck disable=SC2086
        apt_install $archives || say "not all of them are to be had here"
    fi
    if ! merge_shaderc; then
        # shellcheck disable=SC2086
        missing=$(missing_of $SOURCE_PACKAGES)
        say "no static shaderc here: cargo will build it from source once (about 10 minutes)"
        # shellcheck disable=SC2086
        [ -z "$missing" ] || apt_install $missing
    fi
else
    if [ "${MOIRE_SETUP_DRY_RUN:-0}" = 1 ]; then say "would install nothing: no apt-get here"; exit 0; fi
    merge_shaderc || true
    say "this system has no apt-get; install by hand, if missing:"
    say "  the Vulkan loader (vulkan-loader), a driver (Mesa's lavapipe runs on any CPU),"
    say "  the Khronos validation layers (for the tests), a C++ compiler, cmake, git and python3"
fi
