#!/bin/sh
# Make sure that the programs the tests need are there: install them on Debian as root, else say the command.
set -eu
cd "$(dirname "$0")/.."
missing=""
need() { # program, package
    PATH="$PATH:/usr/sbin" command -v "$1" >/dev/null 2>&1 || missing="$missing $2"
}
need chromium-headless-shell chromium-headless-shell
need mosquitto mosquitto
need mosquitto_passwd mosquitto
need mbpoll mbpoll
need socat socat
need openssl openssl
need gcc gcc
need strace strace
need faketime faketime
need npm npm
need systemd-analyze systemd
need avr-g++ gcc-avr
need avr-objcopy binutils-avr
[ -e /usr/lib/avr/include/avr/io.h ] || missing="$missing avr-libc"
[ -e /usr/include/simavr/sim_avr.h ] || missing="$missing libsimavr-dev"
[ -e /usr/include/libelf.h ] || missing="$missing libelf-dev"
[ -e /usr/include/modbus/modbus.h ] || missing="$missing libmodbus-dev libc6-dev"
ls /usr/lib/postgresql/*/bin/initdb >/dev/null 2>&1 || missing="$missing postgresql"
if [ -n "$missing" ]; then
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null 2>&1; then
        echo "Installing what the tests need:$missing"
        apt-get update -qq
        # shellcheck disable=SC2086
        DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
    else
        echo "The tests need:$missing. Install them with: sudo apt-get install --no-install-recommends$missing" >&2
        exit 1
    fi
fi

# The npm package modbus-serial, an independent Modbus client. Its serialport is 12: 13 wants Node.js 20, and
# Debian 12 has 18.
peer=tests/peers/modbus-serial
built=build/modbus-serial
if ! cmp -s "$peer/package-lock.json" "$built/node_modules/.locked" 2>/dev/null; then
    mkdir -p "$built"
    cp "$peer/package.json" "$peer/package-lock.json" "$built"
    npm ci --prefix "$built" --ignore-scripts --no-audit --no-fund --loglevel=error
    cp "$peer/package-lock.json" "$built/node_modules/.locked"
fi
