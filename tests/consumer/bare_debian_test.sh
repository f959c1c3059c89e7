#!/usr/bin/env bash
# bare_debian_test.sh PACKAGES   as root: makes a bare Debian 12 in a temporary folder, installs the
# packages there and uses them: the programs first, then the Python package, then, with a compiler,
# the library.
set -euo pipefail
packages=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
root=$(mktemp -d)
finish() {
  umount "$root/proc" 2>/dev/null || true
  rm -rf --one-file-system "$root"
}
trap finish EXIT

# inside COMMANDS   runs them there, without what this shell's environment says of its own tools
inside() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive sh -euc "$1"
}

debootstrap --variant=minbase bookworm "$root" >/dev/null
mount -t proc proc "$root/proc"
cp "$packages"/*.deb "$here/../../scenarios/arm_breaks_a.json" "$here"/{CMakeLists.txt,main.cpp} \
  "$root/tmp"

# install PACKAGES   what is said only if it fails
install() {
  inside "apt-get -qq install -y --no-install-recommends $* >/tmp/log 2>&1 ||
          { cat /tmp/log; exit 1; }"
}

install '/tmp/holdfast_*.deb' '/tmp/libholdfast0.*.deb'
echo "installed in Debian $(cat "$root/etc/debian_version"): $(inside 'holdfast --version')"
inside 'holdfast check --quiet --certificate /tmp/proof /tmp/arm_breaks_a.json
        holdfast-checker /tmp/proof
        holdfast view --out - /tmp/arm_breaks_a.json >/tmp/page.html
        grep -q arm_breaks_a /tmp/page.html'

# The images are a package of their own, made where they are built.
if ls "$packages"/holdfast-firmware_*.deb >/dev/null 2>&1; then
  install '/tmp/holdfast-firmware_*.deb'
  inside 'holdfast emulate --quiet /tmp/arm_breaks_a.json'
else
  # shellcheck disable=SC2016  # The shell inside expands it.
  inside 'code=0
          holdfast emulate /tmp/arm_breaks_a.json 2>/tmp/log || code=$?
          [ $code -eq 65 ]
          grep -Eq "holdfast-firmware|without Unicorn" /tmp/log'
fi

install '/tmp/python3-holdfast_*.deb'
inside 'cd / && python3 -c "
import holdfast
r = holdfast.Robot([[0,0,0],[0,0,1],[1,0,1]], planned=[[2,0,1]]).check()
assert r.verdict.name in (\"SAFE\", \"OVERLOAD\", \"UNSTABLE\", \"UNDECIDED\")
assert r.connections[\"load_ratio\"].max() > 0
assert holdfast.load(\"/tmp/arm_breaks_a.json\").check().verdict is holdfast.Verdict.SAFE
print(\"Python:\", repr(r))"'

install '/tmp/*.deb' g++ cmake ninja-build pkg-config
for kind in shared static; do
  inside "{ cmake -S /tmp -B /tmp/$kind -G Ninja -DKIND=$kind &&
            cmake --build /tmp/$kind; } >/tmp/log || { cat /tmp/log; exit 1; }
          /tmp/$kind/consumer"
done
# shellcheck disable=SC2016  # the flags are found inside
inside 'g++ -std=c++20 /tmp/main.cpp $(pkg-config --cflags --libs holdfast) -o /tmp/by_pkg_config
        /tmp/by_pkg_config'
