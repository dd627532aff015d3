#!/usr/bin/env bash
# The package, made and installed in a bare Debian 12 (debootstrap, minbase), and run there.
#   bare_debian.sh BUILD CACHE      CACHE keeps the bare system and what apt fetched for the next time
# Exit code 77: it cannot be tried here, the reason is printed.
set -euo pipefail
build=$1 cache=$2
release=bookworm
skip() { echo "skipped: $*"; exit 77; }

[ "$(id -u)" -eq 0 ] || skip "needs root (chroot)"
for tool in debootstrap unshare dpkg-shlibdeps file cpack; do
  command -v $tool >/dev/null || skip "$tool is not installed (packages.txt, group package)"
done
unshare --mount true 2>/dev/null || skip "no mount namespaces in this container"
grep -q "VERSION_CODENAME=$release" /etc/os-release || skip "this computer is no Debian 12: its libraries are others"
mkdir -p "$cache"
exec 9>"$cache/lock"
flock 9

# The mirror that this computer's apt uses.
mirror=$(apt-get indextargets --format '$(REPO_URI)' "Codename: $release" 'Component: main' 2>/dev/null | head -n 1)
mirror=${mirror:-http://deb.debian.org/debian}
if [ ! -e "$cache/bare/.complete" ]; then
  rm -rf --one-file-system "$cache/bare"
  debootstrap --variant=minbase "$release" "$cache/bare" "$mirror" >"$cache/debootstrap.log" 2>&1 ||
    { tail -n 5 "$cache/debootstrap.log"; rm -rf --one-file-system "$cache/bare"; skip "debootstrap from $mirror failed"; }
  cp /etc/resolv.conf "$cache/bare/etc/resolv.conf"
  # Sources, proxies and keys as this computer has them, as far as they are Debian's.
  rm -f "$cache/bare/etc/apt/sources.list"
  cp -a /etc/apt/sources.list.d/debian.sources "$cache/bare/etc/apt/sources.list.d/" 2>/dev/null ||
    echo "deb $mirror $release main" >"$cache/bare/etc/apt/sources.list"
  apt-config dump Acquire::http::Proxy Acquire::https::Proxy >"$cache/bare/etc/apt/apt.conf.d/90proxy"
  touch "$cache/bare/.complete"
fi

rm -rf "$build/package"
(cd "$build" && cpack --config CPackConfig.cmake) >"$cache/cpack.log" 2>&1 || { cat "$cache/cpack.log"; exit 1; }
package=$(ls "$build"/package/omnihil_*.deb)
echo "package: $(basename "$package"), $(stat -c %s "$package") bytes"
dpkg-deb --field "$package" Depends

# A fresh copy of the bare system, in a mount namespace that ends with it.
export system=$cache/system cache package
rm -rf --one-file-system "$system"
cp -a --reflink=auto "$cache/bare" "$system"
mkdir -p "$cache/archives"
cp "$cache/archives/"*.deb "$system/var/cache/apt/archives/" 2>/dev/null || true
[ ! -d "$cache/lists" ] || cp -a "$cache/lists/." "$system/var/lib/apt/lists/"
cp "$package" "$system/tmp/omnihil.deb"
status=0
unshare --mount --propagation private bash -euo pipefail -c '
  mount -t proc proc "$system/proc"
  mount --bind /dev "$system/dev"
  mount -t devpts devpts "$system/dev/pts" -o newinstance,ptmxmode=0666 2>/dev/null || mount --bind /dev/pts "$system/dev/pts"
  in_system() { chroot "$system" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
  apt="apt-get -qq -y --no-install-recommends -o APT::Sandbox::User=root"
  if ! in_system $apt --download-only install /tmp/omnihil.deb >/dev/null 2>&1; then  # lists of another day, or none
    in_system $apt update >"$cache/apt.log" 2>&1 || { tail -n 3 "$cache/apt.log"; exit 77; }
    in_system $apt --download-only install /tmp/omnihil.deb >"$cache/apt.log" 2>&1 || {
      cat "$cache/apt.log"; ! grep -q "Failed to fetch\|Could not resolve" "$cache/apt.log" || exit 77; exit 1; }
    rm -rf "$cache/lists" && cp -a "$system/var/lib/apt/lists" "$cache/lists"
  fi
  cp -n "$system/var/cache/apt/archives/"*.deb "$cache/archives/"
  in_system $apt install /tmp/omnihil.deb >"$cache/install.log" 2>&1 || { cat "$cache/install.log"; exit 1; }
  cd /
  in_system omnihil --version
  in_system omnihil models | grep -q "^omni_default "
  in_system omnihil serve --device /tmp/dongle --clock free --duration 0.2 --robots 0-5 --record /tmp/run.omnirec --quiet
  in_system omnihil check /tmp/run.omnirec
  in_system omnihil scenario run wheel/direction --firmware /usr/lib/omnihil/libomnihil_reference_firmware.so
  in_system omnihil sim maxon_ec45_flat_50w --excite steps --duration 1 --amplitude 0.3 --out /tmp/bench
  in_system test -s /usr/share/man/man1/omnihil-serve.1 || in_system grep -q "path-exclude.*man" -r /etc/dpkg
  in_system bash -c "source /usr/share/bash-completion/completions/omnihil && complete -p omnihil" >/dev/null
  in_system dpkg --verify omnihil
  umount "$system/proc"  # then the program is found by the path that it was started by
  in_system omnihil models | grep -q "^omni_default "
' || status=$?
rm -rf --one-file-system "$system"
[ $status -ne 77 ] || skip "the packages that it depends on could not be fetched from $mirror"
exit $status
