#!/usr/bin/env bash
# clean_debian.sh PACKAGES FOLDER: installs the packages in a Debian made in FOLDER, which has nothing else, and uses them as a newcomer
# would. As root.
set -euo pipefail
packages=$1 root=$2
example=$(dirname "${BASH_SOURCE[0]}")/example

say() { printf '── %s\n' "$*"; }
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }

# shellcheck disable=SC1091
source /etc/os-release
if [[ ! -e $root/usr/bin/apt-get ]]; then
  say "a Debian ($VERSION_CODENAME) in $root"
  mirror=$(sed -nE 's,^(URIs: |deb )(https?://[^ ]*/debian)/?( .*)?$,\2,p' /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null | head -1 || true)
  debootstrap --variant=minbase "$VERSION_CODENAME" "$root" ${mirror:+"$mirror"} >"$root.log" 2>&1 || {
    tail -20 "$root.log"
    exit 1
  }
  cp /etc/apt/apt.conf.d/* "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
  cp /etc/resolv.conf /etc/hosts "$root/etc/" 2>/dev/null || true
fi
mount --bind /proc "$root/proc"
trap 'umount "$root/proc"' EXIT

say "the program"
rm -rf "$root/packages"
cp -r "$packages" "$root/packages"
inside apt-get update -q >/dev/null
inside sh -c 'apt-get install -q -y --no-install-recommends /packages/keyblock_*.deb' >"$root.log" 2>&1 || { tail "$root.log"; exit 1; }
start=$SECONDS
inside keyblock run /usr/share/keyblock/examples/03-block-on-incline.toml -o /root/out
inside test -s /root/out/report.html
say "first report after $((SECONDS - start)) s"
inside keyblock verify incline | tail -n 1

say "the Python module"
inside sh -c 'apt-get install -q -y --no-install-recommends /packages/python3-keyblock_*.deb' >"$root.log" 2>&1 || { tail "$root.log"; exit 1; }
inside python3 - <<'END'
import keyblock
scenario = keyblock.Scenario.load("/usr/share/keyblock/examples/03-block-on-incline.toml")
summary = scenario.run("/root/python")
there = keyblock.open("/root/out").summary
assert summary["state_hash"] == there["state_hash"], (summary["state_hash"], there["state_hash"])
print("keyblock", keyblock.__version__, "from Python: the same bits,", summary["state_hash"])
END

say "the wheel, in an environment of its own"
inside sh -c 'apt-get install -q -y --no-install-recommends python3-venv' >"$root.log" 2>&1 || { tail "$root.log"; exit 1; }
inside sh -c 'apt-get remove -q -y python3-keyblock' >"$root.log" 2>&1
inside sh -c 'rm -rf /root/venv && python3 -m venv --system-site-packages /root/venv && /root/venv/bin/pip install -q --no-index --no-deps /packages/keyblock-*.whl'
inside /root/venv/bin/python -c 'import keyblock; print("the wheel has", keyblock.Scenario().simulate.__name__, keyblock.__version__)'

say "the C++ library"
inside sh -c 'apt-get install -q -y --no-install-recommends /packages/libkeyblock-dev_*.deb g++ cmake make pkg-config' >"$root.log" 2>&1 || { tail "$root.log"; exit 1; }
rm -rf "$root/root/example" "$root/root/cxx"
cp -r "$example" "$root/root/example"
inside sh -c 'cmake -S /root/example -B /root/example/build >/dev/null && cmake --build /root/example/build >/dev/null'
inside /root/example/build/outside /usr/share/keyblock/examples/03-block-on-incline.toml /root/cxx
# shellcheck disable=SC2016
inside sh -c 'g++ -std=c++20 /root/example/main.cpp -o /root/by-pkg-config $(pkg-config --cflags --libs keyblock)'
say "all packages work"
