#!/bin/sh
# Tries the commands of the README as a new user would, on a bare Debian: makes a minimal system of the given release in
# the given folder (with no git, sudo, compiler or certificates), copies the committed tree in and runs a command there.
#
#   .ci/try-debian.sh bookworm|trixie FOLDER [COMMAND...]      default command: ./test.sh
#
# Needs root and debootstrap. A folder that already holds such a system is used again: only the tree is renewed, so
# that its build and compiler cache are kept. Packages come from the mirror that this machine uses itself.
set -eu

if [ $# -lt 2 ]; then
    sed -n '2,9s/^# \{0,1\}//p' "$0" >&2
    exit 64
fi
release=$1
mkdir -p "$2"
root=$(cd "$2" && pwd)
shift 2
[ $# -gt 0 ] || set -- ./test.sh
repository=$(cd "$(dirname "$0")/.." && pwd)
home=/root/penumbra

# The first source that serves Debian itself (not its security suite, not a third party), in either notation of apt.
find_mirror() {
    cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources 2>/dev/null |
        sed -n -e 's/^deb \(\[[^]]*\] \)\{0,1\}\([^ ]*\/debian\)\/\{0,1\} .*/\2/p' \
               -e 's/^URIs: *\([^ ]*\/debian\)\/\{0,1\}\( .*\)\{0,1\}$/\1/p' | head -n 1
}

if [ ! -e "$root/etc/debian_version" ]; then
    mirror=$(find_mirror)
    if [ -z "$mirror" ]; then
        echo "try-debian: found no Debian mirror in /etc/apt/sources.list*" >&2
        exit 78
    fi
    include=""
    case $mirror in
        https:*) include="--include=ca-certificates" ;; # apt could not reach its mirror otherwise
    esac
    debootstrap --variant=minbase $include "$release" "$root" "$mirror"
fi
cp /etc/resolv.conf "$root/etc/resolv.conf"

mkdir -p "$root$home"
find "$root$home" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
git -C "$repository" archive HEAD | tar -x -C "$root$home"

# A mount namespace of its own, so that /proc goes away with the command however it ends. Only what a login sets is in
# the environment.
export root home
exec unshare --mount -- sh -eu -c '
    mount -t proc proc "$root/proc"
    mountpoint -q "$root/dev/shm" || { mkdir -p "$root/dev/shm" && mount -t tmpfs tmpfs "$root/dev/shm"; }
    exec chroot "$root" env -i HOME=/root USER=root TERM=dumb ${CI:+CI="$CI"} \
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        sh -c "cd \"\$0\" && exec \"\$@\"" "$home" "$@"' sh "$@"
