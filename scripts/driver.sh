# Sourced by demo.sh and test.sh: makes sure that a Vulkan driver is there, installs Mesa's software
# one on Debian and Ubuntu only if none is, and elsewhere says what to install.

have_driver() {
    # A loader, and the manifest of at least one driver.
    ldconfig -p 2>/dev/null | grep -q 'libvulkan\.so\.1' || return 1
    [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] && return 0
    for manifest in /usr/share/vulkan/icd.d/*.json /usr/local/share/vulkan/icd.d/*.json \
        /etc/vulkan/icd.d/*.json; do
        [ -e "$manifest" ] && return 0
    done
    return 1
}

need_driver() {
    case "$(uname -s)" in
    Linux) ;;
    *) return 0 ;; # Metal and Direct3D 12 come with the system
    esac
    have_driver && return 0
    if command -v apt-get >/dev/null 2>&1; then
        sudo=
        [ "$(id -u)" -eq 0 ] || sudo=sudo
        echo 'No Vulkan driver found: installing Mesa with its software driver.' >&2
        $sudo apt-get update -qq &&
            $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
                mesa-vulkan-drivers libvulkan1 >/dev/null || true
        have_driver && return 0
    fi
    echo 'No Vulkan driver found. Install the one for your GPU, or a software driver:' >&2
    echo '  Debian, Ubuntu  apt-get install mesa-vulkan-drivers libvulkan1' >&2
    echo '  Fedora          dnf install mesa-vulkan-drivers vulkan-loader' >&2
    echo '  Arch            pacman -S vulkan-swrast vulkan-icd-loader' >&2
    return 1
}

need_cargo() {
    command -v cargo >/dev/null 2>&1 && return 0
    echo 'cargo not found: install Rust 1.88 or newer, see https://rustup.rs' >&2
    return 1
}

# meshoptimizer, which a test and a bench compare with, is compiled from C++.
need_compiler() {
    command -v c++ >/dev/null 2>&1 && return 0
    if command -v apt-get >/dev/null 2>&1; then
        sudo=
        [ "$(id -u)" -eq 0 ] || sudo=sudo
        echo 'No C++ compiler found: installing g++.' >&2
        $sudo apt-get update -qq && $sudo apt-get install -y -qq g++ >/dev/null && return 0
    fi
    echo 'No C++ compiler found: install g++ or clang.' >&2
    return 1
}
