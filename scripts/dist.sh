#!/usr/bin/env bash
# Packs dist/conelab-VERSION-x86_64-linux.tar.gz: a program that needs glibc, libgcc and a Vulkan loader with a driver.
# Where dpkg-deb is there, also a Debian package of the same; and SHA256SUMS.
#
#   scripts/dist.sh VERSION
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

version=$1
name=conelab-$version-$(uname -m)-linux
target=${CARGO_TARGET_DIR:-target}
mkdir -p "$target" dist
work=$(mktemp -d "$target/dist.XXXXXX")
trap 'rm -rf "$work"' EXIT

# A folder that holds only the static libstdc++ comes first in the linker's search, so that the program carries it.
mkdir "$work/static"
ln -s "$(c++ -print-file-name=libstdc++.a)" "$work/static/libstdc++.a"
cargo rustc --release --locked --bin conelab -- -L "native=$(realpath "$work/static")" -C strip=symbols

out=$work/$name
mkdir "$out"
cp "$target/release/conelab" "$out/"
cp -r passes shaders configs LICENSE LICENSE-MIT LICENSE-APACHE "$out/"
[[ ! -f README.md ]] || cp README.md "$out/"

# What the program is made of. The crates' texts are in their sources; the shader compiler's follow.
{
    printf 'Statically linked into conelab %s, with their licences.\n\n' "$version"
    cargo tree --locked --edges normal --prefix none --format '{p}  {l}' | sed 's/ (proc-macro)//; s/ (\*)//' | grep -v '^conelab ' | sort -u
    for package in libshaderc-dev glslang-dev spirv-tools libstdc++6; do
        [[ -f /usr/share/doc/$package/copyright ]] || continue
        printf '\n%s\n%s\n\n' "$package" "$(tr '[:print:]' = <<<"$package" | tr -d '\n')"
        cat "/usr/share/doc/$package/copyright"
    done
} >"$out/THIRD-PARTY.txt"

needed=$(objdump -p "$out/conelab" | sed -n 's/^ *NEEDED *//p')
glibc=$(objdump -T "$out/conelab" | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -n 1)
for library in $needed; do
    case $library in
    libc.so.* | libm.so.* | libgcc_s.so.* | ld-linux*) ;;
    *) echo "dist: error: the program needs $library, which other machines may lack" >&2 && exit 1 ;;
    esac
done
cat >"$out/NEEDS.txt" <<TEXT
Linux on $(uname -m) with glibc ${glibc#GLIBC_} or newer, libgcc_s.so.1, and a Vulkan 1.3 loader and driver
(Debian, Ubuntu: libvulkan1 mesa-vulkan-drivers). Run ./conelab in this folder, or set CONELAB_HOME to it.
TEXT
tar -C "$work" --owner=0 --group=0 --sort=name -czf "dist/$name.tar.gz" "$name"
files=("$name.tar.gz")

if command -v dpkg-deb >/dev/null; then
    arch=$(dpkg --print-architecture)
    deb=$work/deb
    mkdir -p "$deb/DEBIAN" "$deb/usr/bin" "$deb/usr/share/conelab" "$deb/usr/share/doc/conelab"
    cp "$out/conelab" "$deb/usr/bin/"
    cp -r "$out/passes" "$out/shaders" "$out/configs" "$deb/usr/share/conelab/"
    cat LICENSE LICENSE-MIT LICENSE-APACHE >"$deb/usr/share/doc/conelab/copyright"
    cp "$out/THIRD-PARTY.txt" "$deb/usr/share/doc/conelab/"
    cat >"$deb/DEBIAN/control" <<CONTROL
Package: conelab
Version: $version
Architecture: $arch
Maintainer: The conelab authors <noreply@invalid>
Section: graphics
Priority: optional
Installed-Size: $(du -sk "$deb/usr" | cut -f 1)
Depends: libc6 (>= ${glibc#GLIBC_}), libgcc-s1, libvulkan1
Recommends: mesa-vulkan-drivers, libx11-xcb1, libxcursor1, libxi6, libxkbcommon-x11-0, libwayland-client0
Description: research workbench for voxel cone tracing
 Lighting methods as graphs of passes, timed on the GPU and compared with
 path-traced references.
CONTROL
    chmod -R u=rwX,go=rX "$deb"
    dpkg-deb --root-owner-group --build "$deb" "dist/conelab_${version}_$arch.deb" >/dev/null
    files+=("conelab_${version}_$arch.deb")
fi
(cd dist && sha256sum "${files[@]}" >SHA256SUMS)
cat "$out/NEEDS.txt"
(cd dist && du -h "${files[@]}" SHA256SUMS)
