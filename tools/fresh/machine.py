"""A pristine Debian in a folder, with mounts and processes of its own; they end with the machine."""

import fcntl
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from tools.fresh import host

BUILD = Path("build/fresh")
USER = "tester"
PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
OWN = ("--mount", "--pid", "--uts", "--ipc")
INTERPRETER = "/opt/python"

# The first process of a machine. All mounts are made in its own namespace: the computer never sees them, and
# they are gone when it ends. pivot_root and not chroot: Chromium's sandbox is refused in a chroot.
FIRST = """
set -eu
cd "$1"; shift
mount --bind . .
cd "$PWD"
mount -t proc proc proc
mount -t sysfs -o ro sysfs sys
mount -t tmpfs -o mode=755 tmpfs dev
while read -r name major minor; do
    mknod -m 666 "dev/$name" c "$major" "$minor"
done <<DEVICES
null 1 3
zero 1 5
full 1 7
random 1 8
urandom 1 9
tty 5 0
DEVICES
ln -s /proc/self/fd dev/fd
ln -s fd/0 dev/stdin
ln -s fd/1 dev/stdout
ln -s fd/2 dev/stderr
ln -s pts/ptmx dev/ptmx
mkdir dev/pts dev/shm
mount -t devpts -o newinstance,ptmxmode=666,mode=620 devpts dev/pts
mount -t tmpfs -o mode=1777 tmpfs dev/shm
for pair in "$@"; do # seen read-only: FROM=TO
    from=${pair%%=*} to=.${pair#*=}
    if [ -d "$from" ]; then mkdir -p "$to"; else mkdir -p "${to%/*}"; touch "$to"; fi
    mount --bind "$from" "$to"
    mount -o remount,bind,ro "$to"
done
hostname fresh
pivot_root . mnt
cd /
umount -l mnt
echo ready
exec sh -c 'sleep infinity & wait'
"""

# No services start by themselves, as in any container: ports of this computer are not the machine's to take.
NO_SERVICES = "#!/bin/sh\nexit 101\n"


def pristine(debian: str) -> Path:
    """Return the minimal Debian as an archive; it is built once and kept."""
    kept = BUILD / f"debian-{debian}.tar"
    if kept.exists():
        return kept
    if shutil.which("mmdebstrap") is None:
        print("Installing mmdebstrap ...", flush=True)
        install = "apt-get update -qq && apt-get install -y -qq --no-install-recommends mmdebstrap >/dev/null"
        if subprocess.run(["sh", "-c", install], check=False).returncode:
            sys.exit("make fresh needs mmdebstrap. Install it with: apt-get install mmdebstrap")
    lines = host.sources(debian)
    BUILD.mkdir(parents=True, exist_ok=True)
    settings, log, new = (BUILD / f"debian-{debian}.{end}" for end in ("apt", "log", "new.tar"))
    settings.write_text(host.apt_settings())
    more = ["--include=ca-certificates"] if any(" https:" in line for line in lines) else []
    suite = host.SUITES.get(debian, debian)
    print(f"Building a pristine Debian {debian} ({log}) ...", flush=True)
    with log.open("w") as told:
        command = ["mmdebstrap", "--variant=minbase", *more, f"--aptopt={settings}", suite, str(new), *lines]
        if subprocess.run(command, stdout=told, stderr=told, check=False).returncode:
            sys.exit(f"Debian {debian} could not be built: see {log}")
    new.rename(kept)
    return kept


@dataclass
class Machine:
    """A running machine and what is known about it."""

    root: Path
    first: int
    environment: dict[str, str]
    log: IO[str]

    def start(self, line: str, who: str) -> subprocess.Popen[str]:
        """Start a shell line in the user's home, as a group of processes of its own."""
        self.log.write(f"\n$ {line}    # as {who}\n")
        self.log.flush()
        home = "/root" if who == "root" else f"/home/{who}"
        become = ["setpriv", "--reuid", who, "--regid", who, "--init-groups"] if who != "root" else []
        words = ["nsenter", "--target", str(self.first), *OWN, "--", *become, "sh", "-c", f"cd ~ && {line}"]
        settings = {**self.environment, "PATH": PATH, "HOME": home, "USER": who, "LOGNAME": who}
        return subprocess.Popen(
            words,
            env=settings,
            stdin=subprocess.DEVNULL,
            stdout=self.log,
            stderr=self.log,
            start_new_session=True,
            text=True,
        )

    def do(self, line: str, who: str) -> tuple[int, str]:
        """Run a shell line to its end; return its exit code and what it told."""
        begin = os.fstat(self.log.fileno()).st_size
        process = self.start(line, who)
        try:
            code = process.wait()
        finally:
            stop(process)
        with Path(self.log.name).open(errors="replace") as log:
            log.seek(begin)
            return code, log.read()


def stop(process: subprocess.Popen[str]) -> None:
    """Press Ctrl-C, as far as anything of the group of processes is left."""
    try:
        os.killpg(process.pid, signal.SIGINT)
    except ProcessLookupError:
        return
    process.wait()


@contextmanager
def machine(debian: str, name: str, interpreter: Path | None) -> Iterator[Machine]:
    """Give a new machine, and take it away at the end."""
    archive = pristine(debian)
    root = (BUILD / f"debian-{debian}-{name}").resolve()
    with root.with_suffix(".log").open("a") as log:
        try:
            fcntl.flock(log, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            sys.exit(f"Another make fresh has a machine in {root}.")
        log.truncate(0)
        remove(root)
        root.mkdir()
        try:
            subprocess.run(["tar", "-x", "--numeric-owner", "-f", archive, "-C", root], check=True)
            with started(root, interpreter, log) as (first, settings):
                yield Machine(root, first, settings, log)
        finally:
            remove(root)


@contextmanager
def started(root: Path, interpreter: Path | None, log: IO[str]) -> Iterator[tuple[int, dict[str, str]]]:
    """Give the first process of a machine and the variables for those after it; at the end all are ended."""
    pip, settings = host.pip(), host.environment()
    furnish(root, pip)
    seen = [f"{path}={path}" for path in host.folders(pip, *settings.values())]
    if interpreter:
        seen.append(f"{interpreter.parent.parent}={INTERPRETER}")
        settings["LD_LIBRARY_PATH"] = f"{INTERPRETER}/lib"
    words = ["unshare", *OWN, "--fork", "--kill-child", "sh", "-c", FIRST, "first", str(root), *seen]
    outer = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=log, text=True)
    if not outer.stdout or outer.stdout.readline() != "ready\n":
        outer.wait()
        sys.exit(f"The machine could not be made, perhaps as mounts are refused here: see {log.name}")
    first = int(Path(f"/proc/{outer.pid}/task/{outer.pid}/children").read_text())
    try:
        yield first, settings
    finally:
        os.kill(first, signal.SIGKILL)
        outer.wait()


def furnish(root: Path, pip: str) -> None:
    """Give a machine what every computer that is connected has: names, certificates, sources, a user."""
    etc = root / "etc"
    (etc / "hostname").write_text("fresh\n")
    (etc / "hosts").write_text("127.0.0.1 localhost fresh\n::1 localhost\n")
    shutil.copy("/etc/resolv.conf", etc / "resolv.conf")
    if host.CERTIFICATES.is_dir():
        shutil.copytree(host.CERTIFICATES, root / host.CERTIFICATES.relative_to("/"), dirs_exist_ok=True)
    if pip:
        (etc / "pip.conf").write_text(pip)
    refuse = root / "usr/sbin/policy-rc.d"
    refuse.write_text(NO_SERVICES)
    refuse.chmod(0o755)
    (etc / "dpkg/dpkg.cfg.d/unsafe-io").write_text("force-unsafe-io\n")
    subprocess.run(["chroot", root, "useradd", "--create-home", "--shell", "/bin/sh", USER], check=True)


def remove(root: Path) -> None:
    """Remove a machine's folder, but never through a mount."""
    if any(f" {root}" in line for line in Path("/proc/self/mountinfo").read_text().splitlines()):
        sys.exit(f"Something is still mounted in {root}: it is left as it is.")
    if root.exists():
        shutil.rmtree(root)
