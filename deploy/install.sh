#!/bin/sh
# Installs Heliopanel as two services on Debian or Raspberry Pi OS, upgrades it, or takes it away again.
set -eu
umask 022

usage() {
    cat <<'TEXT'
install.sh [WHEEL]                  install, or upgrade what is installed; without WHEEL it takes the one beside
                                    this script, or builds one from the checkout
    --extras LIST                   extras too, with commas: studies, parquet, pdf, postgres, all; an upgrade keeps them
    --wheels FOLDER                 take the libraries from this folder; nothing is downloaded
    --lock FILE                     the locked libraries; default is requirements.txt beside WHEEL or the checkout's
    --python PROGRAM                Python 3.11 or newer; default is python3
    --restore FILE                  restore this backup before the start: the way back to an older version
install.sh --remove [--purge]       take programs and units away; with --purge also settings, data and the user
    --root FOLDER                   put files under this folder; no user is made and nothing is started
TEXT
}

say() { echo "heliopanel: $*"; }
fail() {
    echo "heliopanel: $*" >&2
    exit "${code:-2}"
}

wheel="" extras="" wheels="" lock="" python=python3 restore="" root="" remove="" purge=""
while [ $# -gt 0 ]; do
    case $1 in
    --extras | --wheels | --lock | --python | --restore | --root)
        [ $# -gt 1 ] || fail "$1 needs a value."
        eval "${1#--}=\$2"
        shift
        ;;
    --remove) remove=yes ;;
    --purge) purge=yes ;;
    --help | -h) usage && exit ;;
    -*) fail "There is no option $1. See --help." ;;
    *) wheel=$1 ;;
    esac
    shift
done

here=$(cd "$(dirname "$0")" && pwd)
programs=$root/opt/heliopanel settings=$root/etc/heliopanel data=$root/var/lib/heliopanel
units=$root/etc/systemd/system command=$root/usr/local/bin/heliopanel
services="heliopanel-controller heliopanel-web"
scratch=""
made=""

clean() {
    [ -z "$scratch" ] || rm -rf "$scratch"
    [ -z "$made" ] || rm -rf "$made"
}
trap clean EXIT
trap 'exit 1' INT TERM HUP

# Whether systemd runs the computer that is changed; under --root and in a chroot it does not.
runs_systemd() { [ -z "$root" ] && [ -d /run/systemd/system ]; }
has_user() { [ -z "$root" ] && id heliopanel >/dev/null 2>&1; }
as_user() { HOME=$data HELIOPANEL_CONFIG=$settings/heliopanel.toml HELIOPANEL_DATA_DIR=$data run_as_user "$@"; }
run_as_user() { if has_user; then runuser -u heliopanel -- "$@"; else "$@"; fi; }

check_computer() {
    [ -n "$root" ] || [ "$(id -u)" = 0 ] || fail "Only root may do this. Run it with sudo."
    [ ! -e "$programs/.git" ] || fail "$programs is a checkout of the project. Move it away first."
}

check_tools() {
    [ "$(getconf LONG_BIT)" = 64 ] || fail "This system is a 32-bit one. Heliopanel needs a 64-bit system."
    command -v "$python" >/dev/null || fail "There is no $python. Install it with: apt-get install python3 python3-venv"
    "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' ||
        fail "$($python --version) is too old: Heliopanel needs 3.11 or newer. Name another with --python."
    "$python" -c 'import ensurepip, venv' 2>/dev/null ||
        fail "Python cannot make environments here. Install that with: apt-get install python3-venv"
    if [ -z "$root" ] && ! has_user; then
        command -v useradd >/dev/null || fail "There is no useradd. Install it with: apt-get install passwd"
    fi
}

pip_in() {
    environment=$1
    shift
    "$environment/bin/python" -m pip --quiet --disable-pip-version-check --no-input "$@"
}

# Sets wheel, version and lock.
find_wheel() {
    if [ -z "$wheel" ]; then
        for found in "$here"/heliopanel-*.whl; do
            [ ! -f "$found" ] || wheel=$found
        done
    fi
    if [ -z "$wheel" ] && [ -f "$here/../pyproject.toml" ]; then
        say "building the wheel from the checkout"
        "$python" -m venv "$scratch/build"
        mkdir "$scratch/source"
        tar -C "$here/.." --exclude='./.??*' --exclude=./build --exclude=./data -cf - . | tar -C "$scratch/source" -xf -
        pip_in "$scratch/build" wheel --no-deps -w "$scratch" "$scratch/source" ||
            code=1 fail "The wheel could not be built."
        wheel=$(echo "$scratch"/heliopanel-*.whl)
    fi
    [ -n "$wheel" ] || fail "There is no wheel here. Name it: install.sh heliopanel-VERSION-py3-none-any.whl"
    [ -f "$wheel" ] || fail "There is no file $wheel."
    wheel=$(cd "$(dirname "$wheel")" && pwd)/$(basename "$wheel")
    version=$(basename "$wheel" | sed -n 's/^heliopanel-\([0-9][^-]*\)-.*\.whl$/\1/p')
    [ -n "$version" ] || fail "$wheel is not a wheel of Heliopanel."
    for found in "$(dirname "$wheel")/requirements.txt" "$here/requirements.txt" "$here/../requirements.txt"; do
        [ -n "$lock" ] || [ ! -f "$found" ] || lock=$found
    done
    [ -n "$lock" ] || fail "There is no requirements.txt beside the wheel. Name the locked libraries with --lock."
    [ -f "$lock" ] || fail "There is no file $lock."
}

# Prints those lines of the lock that a report of pip says are needed.
needed_lines() {
    "$python" - "$1" "$lock" <<'PYTHON'
import json, re, sys

def plain(name):
    return re.sub(r"[-_.]+", "-", name).lower()

with open(sys.argv[1]) as report:
    wanted = {plain(one["metadata"]["name"]) for one in json.load(report)["install"]} - {"heliopanel"}
found, keep = set(), False
for line in open(sys.argv[2]):
    if not line[0].isspace():
        name = plain(re.split(r"[^\w.-]", line)[0])
        keep = name in wanted
        found |= {name}
    if keep:
        print(line, end="")
if wanted - found:
    sys.exit(f"The lock does not name {', '.join(sorted(wanted - found))}.")
PYTHON
}

# Only what the lock names is installed, each file with the checksum that stands there.
make_environment() {
    [ -n "$extras" ] || extras=$(cat "$programs/current/extras" 2>/dev/null || true)
    made=$programs/$version-$(date -u +%Y%m%dT%H%M%S)
    say "making $made: Heliopanel $version and its libraries${extras:+ with $extras}"
    mkdir -p "$programs"
    "$python" -m venv "$made"
    echo "$extras" >"$made/extras"
    sed -n 's/^\([A-Za-z0-9._-]*==[^ ;\\]*\).*/\1/p' "$lock" >"$scratch/versions"
    echo "heliopanel${extras:+[$extras]} @ file://$wheel" >"$scratch/asked"
    pip_in "$made" install --dry-run --ignore-installed --only-binary :all: --report "$scratch/report" \
        -c "$scratch/versions" -r "$scratch/asked" ||
        code=1 fail "The libraries could not be had; nothing was changed."
    needed_lines "$scratch/report" >"$scratch/needed" ||
        fail "This lock does not belong to this wheel; nothing was changed."
    if ! pip_in "$made" install --require-hashes --no-deps --only-binary :all: -r "$scratch/needed" ||
        ! pip_in "$made" install --no-deps "$wheel"; then
        code=1 fail "The libraries could not be installed; nothing was changed."
    fi
    "$made/bin/python" -m pip --disable-pip-version-check check >"$scratch/check" || {
        cat "$scratch/check" >&2
        fail "This lock does not belong to this wheel; nothing was changed."
    }
}

make_user() {
    [ -z "$root" ] || return 0
    if ! has_user; then
        say "making the user heliopanel"
        useradd --system --user-group --home-dir /var/lib/heliopanel --no-create-home \
            --shell /usr/sbin/nologin heliopanel
    fi
    usermod --append --groups dialout heliopanel
}

make_folders() {
    say "settings are in $settings, data in $data"
    install -d -m 0750 "$settings"
    install -d -m 0700 "$data"
    [ -e "$settings/heliopanel.toml" ] || install -m 0640 "$here/heliopanel.toml" "$settings/heliopanel.toml"
    if has_user; then
        chown root:heliopanel "$settings" "$settings/heliopanel.toml"
        chown heliopanel:heliopanel "$data"
    fi
    [ ! -e "$root/etc/heliopanel.env" ] ||
        say "/etc/heliopanel.env is no longer read: move what stands there to $settings/heliopanel.toml"
}

# The old version writes it, before anything is changed. A restore keeps what it takes the place of by itself.
keep_backup() {
    if [ -z "$restore" ] && [ -e "$programs/current" ] && [ -e "$data/machine.lock" ]; then
        kept=$data/backups/before-$(basename "$made").db
        say "writing a backup"
        as_user "$programs/current/bin/heliopanel" backup "$kept" ||
            code=1 fail "The backup could not be written; nothing was changed."
    fi
}

# A panel whose controller service is down serves nobody, and would be taken for another program at its port.
stop_lone_panel() {
    if runs_systemd && ! systemctl --quiet is-active heliopanel-controller; then
        systemctl stop heliopanel-web 2>/dev/null || true
    fi
}

# Until 0.2.0 the controller service had another name; two of them would contend for the drives.
end_former_unit() {
    [ -f "$units/heliopanel-machine.service" ] || return 0
    ! runs_systemd || systemctl disable --now heliopanel-machine
    rm -f "$units/heliopanel-machine.service"
}

use_environment() {
    stop_lone_panel
    as_user "$made/bin/heliopanel" config check >"$scratch/check" 2>&1 || {
        cat "$scratch/check" >&2
        fail "The settings are not right for version $version; nothing was changed."
    }
    keep_backup
    previous=$(readlink "$programs/current" || true)
    ln -sfn "$(basename "$made")" "$programs/current.new"
    mv -T "$programs/current.new" "$programs/current"
    for old in "$programs"/*/; do
        case $(basename "$old") in current | "$(basename "$made")" | "$previous") ;; *) rm -rf "$old" ;; esac
    done
    made=""
    install -D -m 0755 "$here/heliopanel" "$command"
    for service in $services; do install -D -m 0644 "$here/$service.service" "$units/$service.service"; done
    end_former_unit
    ! runs_systemd || systemctl daemon-reload
}

# An older version refuses a newer one's data, so this is done before it starts.
restore_backup() {
    [ -n "$restore" ] || return 0
    ! runs_systemd || systemctl stop heliopanel-web heliopanel-controller
    as_user "$programs/current/bin/heliopanel" restore "$restore" || code=1 fail "The backup was not restored."
}

start() {
    if [ -z "$root" ] && command -v systemctl >/dev/null; then
        systemctl --quiet enable heliopanel-controller heliopanel-web
    fi
    if ! runs_systemd; then
        say "Heliopanel $version is installed; systemd does not run here, so nothing was started"
        return
    fi
    for service in $services; do
        say "starting $service"
        if ! systemctl restart "$service"; then
            journalctl --quiet --unit="$service" --lines=5 --output=cat >&2
            code=1 fail "$service does not start; above is what it said."
        fi
    done
    tries=30
    until as_user "$programs/current/bin/heliopanel" status >"$scratch/status"; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || code=1 fail "Not all of it answers: $(cat "$scratch/status")"
        sleep 1
    done
    cat "$scratch/status"
    say "Heliopanel $version runs. How it is, is told by: sudo heliopanel status"
}

take_away() {
    say "taking away programs and units"
    if runs_systemd; then
        for service in $services; do systemctl --quiet disable --now "$service" 2>/dev/null || true; done
    fi
    for service in $services; do
        rm -f "$units/$service.service" "$units/multi-user.target.wants/$service.service"
    done
    ! runs_systemd || systemctl daemon-reload
    rm -rf "$programs" "$command"
    if [ -z "$purge" ]; then
        say "settings ($settings), data ($data) and the user stay; --remove --purge takes them away too"
        return
    fi
    say "taking away settings, data and the user"
    rm -rf "$settings" "$data"
    ! runs_systemd || rm -rf /run/heliopanel
    if has_user && [ "$(id -u heliopanel)" -lt 1000 ]; then userdel heliopanel; fi
}

check_computer
if [ -n "$remove" ]; then
    take_away
    exit
fi
[ -z "$purge" ] || fail "--purge goes with --remove."
check_tools
[ -z "$restore" ] || [ -f "$restore" ] || fail "There is no file $restore."
scratch=$(mktemp -d)
if [ -n "$wheels" ]; then
    [ -d "$wheels" ] || fail "There is no folder $wheels."
    ln -s "$(cd "$wheels" && pwd)" "$scratch/wheels"
    export PIP_NO_INDEX=1 PIP_FIND_LINKS="$scratch/wheels"
fi
find_wheel
make_environment
make_user
make_folders
use_environment
restore_backup
start
