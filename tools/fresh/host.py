"""What this computer's own configuration says about where packages come from; nothing here names a place."""

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

SUITES = {"12": "bookworm", "13": "trixie"}
"""Debian's releases by number; another name, as testing, is a suite itself."""
KEYS = Path("/usr/share/keyrings/debian-archive-keyring.gpg")
CERTIFICATES = Path("/usr/local/share/ca-certificates")
PASSED_ON = ("PIP_", "NPM_CONFIG_", "SSL_CERT_")
PASSED_ON_WHOLE = {
    "HTTP_PROXY",
    "HTTPS_PROXY",
    "NO_PROXY",
    "ALL_PROXY",
    "REQUESTS_CA_BUNDLE",
    "NODE_EXTRA_CA_CERTS",
}
APT_SETTINGS = ("Acquire::http", "Acquire::https", "Acquire::Check-", "Acquire::Retries", "Acquire::Max-")
NPM_SETTINGS = ("registry", "cafile", "proxy", "https-proxy", "noproxy", "strict-ssl")


def said(*command: str) -> str:
    """Return what a command prints; nothing where it is not here or fails."""
    if shutil.which(command[0]) is None:
        return ""
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


def apt_sources(debian: str, targets: str, host_suite: str) -> list[str]:
    """Return the source lines of a Debian, made from those that apt says it uses for this one."""
    suite = SUITES.get(debian, debian)
    ours = {host_suite + more: suite + more for more in ("", "-updates", "-security")}
    lines = []
    for target in targets.splitlines():
        address, release, component = target.split()
        if release in ours:
            lines.append(f"deb [signed-by={KEYS}] {address} {ours[release]} {component}")
    return list(dict.fromkeys(lines))


def sources(debian: str) -> list[str]:
    """Return the source lines of a Debian from this computer's apt."""
    about = dict(
        line.split("=", 1) for line in Path("/etc/os-release").read_text().splitlines() if "=" in line
    )
    form = "$(REPO_URI) $(RELEASE) $(COMPONENT)"
    targets = said("apt-get", "indextargets", "--format", form, "Created-By: Packages")
    lines = apt_sources(debian, targets, about.get("VERSION_CODENAME", "").strip('"'))
    if not lines or not KEYS.exists():
        sys.exit("apt here names no Debian archive to build from, or debian-archive-keyring is missing.")
    return lines


def apt_settings() -> str:
    """Return how apt reaches its sources here: proxies, certificates, checks."""
    lines = said("apt-config", "dump").splitlines()
    return "".join(f"{line}\n" for line in lines if line.startswith(APT_SETTINGS) and '""' not in line)


def pip_settings(listed: str) -> str:
    """Return a pip.conf with what `pip config list` says, without what comes from the environment."""
    sections: dict[str, list[str]] = {}
    for line in listed.splitlines():
        name, _, value = line.partition("=")
        section, _, key = name.rpartition(".")
        if section and not section.startswith(":"):
            told = str(ast.literal_eval(value)).strip().replace("\n", "\n    ")
            sections.setdefault(section, []).append(f"{key} = {told}\n")
    return "".join(f"[{section}]\n{''.join(lines)}" for section, lines in sections.items())


def pip() -> str:
    """Return this computer's pip configuration as a pip.conf."""
    return pip_settings(said(sys.executable, "-m", "pip", "config", "list"))


def environment() -> dict[str, str]:
    """Return the variables by which package managers here find their sources, npm's among them."""
    passed = {
        name: value
        for name, value in os.environ.items()
        if name.upper().startswith(PASSED_ON) or name.upper() in PASSED_ON_WHOLE
    }
    for key in NPM_SETTINGS:
        value = said("npm", "config", "get", key).strip()
        if value not in ("", "null", "undefined"):
            passed[f"npm_config_{key.replace('-', '_')}"] = value
    return passed


def folders(*texts: str) -> list[Path]:
    """Return the local folders and files that configurations name: the machine sees them, read-only."""
    found = []
    for word in " ".join(texts).split():
        path = Path(word.strip("\"';").removeprefix("file://"))
        if not path.is_absolute() or not path.exists() or path.is_relative_to("/etc/ssl"):
            continue
        # The pages of an index on the disk point at files beside them.
        found.append(path.parent if path.name == "simple" else path)
    return list(dict.fromkeys(found))
