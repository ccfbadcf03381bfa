#!/usr/bin/env bash
# Makes this machine able to build conelab: says what is missing, installs it on Debian and Ubuntu, and prepares the
# static shader compiler. Quick and silent when nothing is missing.
#
#   scripts/setup.sh [build] [run] [window] [test] [python]
#
# build: C++ compiler, shader compiler. run: Vulkan loader and drivers. window: libraries of X11 and Wayland. test:
# Vulkan validation layer, a virtual screen and the libraries of a window. python: virtual environments.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf 'setup: %s\n' "$*" >&2; }
die() { printf 'setup: error: %s\n' "$*" >&2; exit 1; }

purposes=" ${*:-build run test} "
wants() { [[ $purposes == *" $1 "* ]]; }

# Static libraries of shaderc, glslang and SPIRV-Tools.
shaderc_packages=(libshaderc-dev glslang-dev spirv-tools)

packages=()
wants build && packages+=(g++ ca-certificates)
wants run && packages+=(libvulkan1 mesa-vulkan-drivers)
{ wants window || wants test; } && packages+=(libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0 libxcb-xkb1 libwayland-client0)
wants test && packages+=(vulkan-validationlayers xvfb)
# A Python of one's own, as pyenv's, needs no package.
makes_environments() { python3 -c 'import ensurepip, venv' 2>/dev/null; }
wants python && ! makes_environments && packages+=(python3 python3-venv)

# ---------------------------------------------------------------------------------------------------- system packages

has_apt() { command -v apt-get >/dev/null && command -v dpkg-query >/dev/null; }

# The given packages that are not installed, one a line.
absent() {
    local found
    found=$(dpkg-query -W -f='${Status} ${Package}\n' "$@" 2>/dev/null | sed -n 's/^[a-z]* ok installed //p' || true)
    printf '%s\n' "$@" | grep -vxF -e "${found:-.}" || true
}

# Runs apt-get as root.
apt_get() {
    local as_root=()
    [[ $EUID -eq 0 ]] || as_root=(sudo)
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 "$@" </dev/null >&2
}

# Asks for sudo's password if need be.
may_install() {
    has_apt || return 1
    [[ $EUID -ne 0 ]] || return 0
    command -v sudo >/dev/null || return 1
    say "this needs root: through sudo"
    sudo -n true 2>/dev/null || sudo -v
}

# What the named purposes lack, whatever the distribution; one a line.
lacks() {
    if wants build; then
        command -v cc >/dev/null || echo "a C compiler as 'cc'"
        command -v c++ >/dev/null || echo "a C++ compiler as 'c++'"
        command -v ar >/dev/null || echo "'ar' (binutils)"
    fi
    if wants run; then
        { PATH=$PATH:/sbin:/usr/sbin ldconfig -p 2>/dev/null || true; } | grep -q 'libvulkan\.so\.1' ||
            echo "the Vulkan loader libvulkan.so.1"
        local drivers
        drivers=$(find /usr/share/vulkan/icd.d /usr/local/share/vulkan/icd.d /etc/vulkan/icd.d \
            "${XDG_DATA_HOME:-${HOME:-/}/.local/share}/vulkan/icd.d" -name '*.json' 2>/dev/null || true)
        [[ -n $drivers${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-} ]] || echo "a Vulkan driver (Mesa's lavapipe is enough)"
    fi
    if wants test; then
        local layers
        layers=$(find /usr/share/vulkan /usr/local/share/vulkan /etc/vulkan -name 'VkLayer_khronos_validation.json' \
            2>/dev/null || true)
        [[ -n $layers${VK_LAYER_PATH:-}${VK_ADD_LAYER_PATH:-} ]] || echo "the Vulkan validation layer"
        command -v Xvfb >/dev/null || echo "the virtual screen 'Xvfb'"
    fi
    if wants python; then
        makes_environments || echo "Python with virtual environments (venv, ensurepip)"
    fi
}

# Installs the packages that are missing. The shader compiler's are wished for; without them the crate builds its own.
install_missing() {
    local missing wished=()
    mapfile -t missing < <([[ ${#packages[@]} -eq 0 ]] || absent "${packages[@]}")
    if wants build && [[ -z ${SHADERC_LIB_DIR:-} && ! -e $bundled_mark ]]; then
        mapfile -t wished < <(absent "${shaderc_packages[@]}")
    fi
    [[ ${#missing[@]} -gt 0 || ${#wished[@]} -gt 0 ]] || return 0

    local list=("${missing[@]}" "${wished[@]}")
    say "missing packages: ${list[*]}"
    if ! may_install; then
        local hint="apt-get install --no-install-recommends ${list[*]}"
        local lacking
        lacking=$(lacks)
        if [[ -z $lacking ]]; then
            say "cannot install packages here (neither root nor sudo); going on with what there is." \
                "If something fails, have an administrator run: $hint"
            return 0
        fi
        die "cannot install packages here (neither root nor sudo), and this machine lacks:
$(sed 's/^/  - /' <<<"$lacking")
Have an administrator run:
  $hint"
    fi
    say "installing them with apt-get"
    apt_get update || say "apt-get update failed; trying with the package lists there are"
    apt_get install -y --no-install-recommends "${list[@]}" && return 0
    if [[ ${#wished[@]} -gt 0 ]]; then
        say "could not install all of them; trying without the shader compiler (${wished[*]})"
        [[ ${#missing[@]} -eq 0 ]] || apt_get install -y --no-install-recommends "${missing[@]}" ||
            die "apt-get could not install: ${missing[*]}"
        return 0
    fi
    die "apt-get could not install: ${missing[*]}"
}

# ---------------------------------------------------------------------------------------------------- shader compiler

merged=.shaderc
bundled_mark=target/shaderc-is-bundled # holds the versions of packages that were tried in vain

# Says which libraries a merge would be made of.
sources() {
    dpkg-query -W -f='${Package} ${Version}\n' "${shaderc_packages[@]}" 2>/dev/null || true
}

# Links and runs a compile of a shader, with optimizer, against $1/libshaderc_combined.a.
links() {
    cat >"$1/try.c" <<'C'
#include <string.h>
#include <shaderc/shaderc.h>
int main(void) {
    const char *text = "#version 460\nlayout(location = 0) out vec4 c; void main() { c = vec4(1.0); }";
    shaderc_compiler_t compiler = shaderc_compiler_initialize();
    shaderc_compile_options_t options = shaderc_compile_options_initialize();
    shaderc_compile_options_set_target_env(options, shaderc_target_env_vulkan, shaderc_env_version_vulkan_1_3);
    shaderc_compile_options_set_optimization_level(options, shaderc_optimization_level_performance);
    shaderc_compilation_result_t result =
        shaderc_compile_into_spv(compiler, text, strlen(text), shaderc_fragment_shader, "t", "main", options);
    return !(result && shaderc_result_get_compilation_status(result) == shaderc_compilation_status_success &&
             shaderc_result_get_length(result) > 20);
}
C
    cc -o "$1/try" "$1/try.c" "$1/libshaderc_combined.a" -lstdc++ -lm -lpthread >"$1/try.log" 2>&1 && "$1/try"
}

# Puts a whole static libshaderc_combined.a in folder $1: the system's own if it is whole, as a few distributions
# have it, else one merged of the parts.
merge() {
    local all own= parts=() name path
    all=$(dpkg -L "${shaderc_packages[@]}" 2>/dev/null | grep '\.a$' || true)
    for name in shaderc_combined shaderc shaderc_util glslang MachineIndependent GenericCodeGen OSDependent \
        OGLCompiler HLSL SPIRV SPIRV-Tools-opt SPIRV-Tools; do
        path=$(grep -m1 "/lib$name\.a$" <<<"$all" || true)
        [[ -n $path ]] || continue
        [[ $name == shaderc_combined ]] && own=$path
        parts+=("$path")
    done
    [[ -n $own ]] || return 1
    cp "$own" "$1/libshaderc_combined.a"
    links "$1" && return 0
    rm "$1/libshaderc_combined.a"
    (
        cd "$1"
        { echo "CREATE libshaderc_combined.a" && printf 'ADDLIB %s\n' "${parts[@]}" && printf 'SAVE\nEND\n'; } | ar -M
    ) && links "$1"
}

# Cargo does not notice that the library changed.
forget_build() {
    local built
    built=$(find "${CARGO_TARGET_DIR:-target}" -maxdepth 4 -name '*shaderc-sys*' -print -quit 2>/dev/null || true)
    [[ -n $built ]] || return 0
    cargo clean --quiet --locked -p shaderc-sys || true
    cargo clean --quiet --locked --release -p shaderc-sys || true
}

shader_compiler() {
    [[ -z ${SHADERC_LIB_DIR:-} ]] || return 0 # the caller's choice
    local from
    from=$(has_apt && sources || true)
    if [[ -e $bundled_mark && $from == "$(<"$bundled_mark")" && ! -e $merged ]]; then
        return 0
    fi
    if [[ -f $merged/libshaderc_combined.a && -f $merged/made-of && $from == "$(<"$merged/made-of")" ]]; then
        return 0
    fi
    mkdir -p target
    local work
    work=$(mktemp -d target/shaderc.XXXXXX)
    if has_apt && merge "$work"; then
        if ! cmp -s "$work/libshaderc_combined.a" "$merged/libshaderc_combined.a"; then
            rm -rf "$merged"
            mkdir "$merged"
            mv "$work/libshaderc_combined.a" "$merged/"
            forget_build
        fi
        printf '%s\n' "$from" >"$merged/made-of"
        rm -rf "$work" "$bundled_mark"
        return 0
    fi
    [[ ! -s $work/try.log ]] || say "the system's shaderc does not link: $(grep -m1 -E 'undefined|error' "$work/try.log" || true)"
    rm -rf "$work"
    bundled "$from"
}

# The shaderc crate shall build its bundled source.
bundled() {
    local tools=()
    command -v cmake >/dev/null || tools+=(cmake)
    command -v git >/dev/null || tools+=(git)
    command -v python3 >/dev/null || tools+=(python3)
    say "no static shaderc from the system's packages: the crate's own source will be built, about 15 minutes on two cores, once"
    if [[ ${#tools[@]} -gt 0 ]]; then
        may_install || die "that needs: ${tools[*]}. Install them, or packages with static libraries of shaderc, glslang and SPIRV-Tools"
        say "installing with apt-get: ${tools[*]}"
        apt_get update || true
        apt_get install -y --no-install-recommends "${tools[@]}" || die "apt-get could not install: ${tools[*]}"
    fi
    if [[ -e $merged ]]; then
        rm -rf "$merged"
        forget_build
    fi
    printf '%s\n' "$1" >"$bundled_mark"
}

# --------------------------------------------------------------------------------------------------------------- main

if ! command -v cargo >/dev/null; then
    die "Rust is missing. Install it as https://rustup.rs says (a compiler of at least version" \
        "$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)), open a new shell and try again"
fi
if has_apt; then
    install_missing
fi
lacking=$(lacks)
[[ -z $lacking ]] || die "this machine lacks:
$(sed 's/^/  - /' <<<"$lacking")
Install these with your system's package manager and try again."
if wants build; then
    shader_compiler
fi
