"""Copies pinned third-party files from npm and Debian packages, and cuts from fonts what pages need of them.

`check` says, offline, whether anybody changed one, and whether the catalogues use a letter that was not cut.
"""

import base64
import hashlib
import json
import subprocess
import sys
import tarfile
import tempfile
import tomllib
from pathlib import Path
from typing import NotRequired, TypedDict

from babel.messages.pofile import read_po

HERE = Path(__file__).parent
MANIFEST = HERE / "manifest.json"
LANGUAGES = HERE.parents[1] / "app" / "web"
FIRST_OF_CHINESE = "\u2e80"
"""From here on Unicode has the letters and punctuation of Chinese; what stands before has our Latin font."""


class Vendored(TypedDict):
    """One package in the manifest: its pin, the checksum of the archive and ours of each file."""

    package: str
    version: str
    licence: str
    integrity: str
    files: dict[str, str]
    letters: NotRequired[dict[str, str]]


def wanted() -> dict[str, dict[str, object]]:
    """Return the packages that vendor.toml lists."""
    return tomllib.loads((HERE / "vendor.toml").read_text())


def digest(content: bytes) -> str:
    """Return the SHA-384 of a file as browsers write it in `integrity`."""
    return "sha384-" + base64.b64encode(hashlib.sha384(content).digest()).decode()


def pack(package: str, version: str, folder: Path) -> tuple[Path, str]:
    """Fetch one archive with npm and return it with its SHA-512, which npm has verified."""
    command = ["npm", "pack", "--json", "--pack-destination", str(folder), f"{package}@{version}"]
    answer = subprocess.run(command, check=True, capture_output=True, text=True)  # noqa: S603 - fixed words and our own pins
    told = json.loads(answer.stdout)[0]
    return folder / told["filename"], told["integrity"]


def pack_debian(package: str, version: str, folder: Path) -> tuple[Path, str]:
    """Fetch one archive with apt, which verifies it, and return the files in it as a tar with its SHA-512."""
    fetch = ["apt-get", "download", f"{package}={version}"]
    subprocess.run(fetch, check=True, capture_output=True, cwd=folder)  # noqa: S603 - fixed words and our own pins
    archive = next(folder.glob(f"{package}_*.deb"))
    unpack = ["dpkg-deb", "--fsys-tarfile", str(archive)]
    tar = subprocess.run(unpack, check=True, capture_output=True).stdout  # noqa: S603 - the file fetched above
    (folder / f"{package}.tar").write_bytes(tar)
    integrity = base64.b64encode(hashlib.sha512(archive.read_bytes()).digest()).decode()
    return folder / f"{package}.tar", f"sha512-{integrity}"


SOURCES = {"npm": (pack, "package"), "debian": (pack_debian, ".")}
"""How a package is fetched, and below which folder its files stand in the archive."""


def copy(archive: Path, inside: str, files: list[str], target: Path) -> dict[str, str]:
    """Copy the listed files out of an archive and return their checksums by path below `static/vendor`."""
    target.mkdir(parents=True, exist_ok=True)
    checksums = {}
    with tarfile.open(archive) as packed:
        for name in files:
            member = packed.extractfile(f"{inside}/{name}")
            if member is None:
                raise SystemExit(f"{archive.name} holds no file {name}; correct vendor.toml.")
            content = member.read()
            (target / Path(name).name).write_bytes(content)
            checksums[str((target / Path(name).name).relative_to(HERE))] = digest(content)
    return checksums


def letters_of(language: str) -> str:
    """Return every Chinese letter that a catalogue, or the table of languages, says."""
    with (LANGUAGES / "locale" / language / "LC_MESSAGES" / "heliopanel.po").open("rb") as file:
        said = [message.string for message in read_po(file)]
    texts = [text for one in said for text in ((one,) if isinstance(one, str) else one)]
    texts.append((LANGUAGES / "languages" / "known.py").read_text(encoding="utf-8"))
    return "".join(sorted({letter for letter in "".join(texts) if letter >= FIRST_OF_CHINESE}))


def wanted_letters(subset: dict[str, str]) -> str:
    """Return the letters of a font that vendor.toml says by themselves or by the language that uses them."""
    return subset["letters"] if "letters" in subset else letters_of(subset["language"])


def cut(folder: Path, subsets: dict[str, dict[str, str]]) -> tuple[dict[str, str], dict[str, str]]:
    """Make fonts with a few letters of a copied one; return their checksums and their letters by path."""
    checksums, letters = {}, {}
    for name, subset in subsets.items():
        path = str((folder / name).relative_to(HERE))
        letters[path] = wanted_letters(subset)
        options = ["--flavor=woff2", "--layout-features=*", "--no-hinting", f"--output-file={folder / name}"]
        fonttools = [sys.executable, "-m", "fontTools.subset", str(folder / subset["of"])]
        subprocess.run([*fonttools, f"--text={letters[path]}", *options], check=True)  # noqa: S603 - our own pins
        checksums[path] = digest((folder / name).read_bytes())
    return checksums, letters


def recut() -> None:
    """Cut the fonts anew from the copies that are here, and put them into the manifest; needs no network."""
    manifest: dict[str, Vendored] = json.loads(MANIFEST.read_text())
    for name, entry in wanted().items():
        if subsets := entry.get("subset"):
            target = HERE / name / str(entry["version"]).rpartition(":")[2]
            checksums, manifest[name]["letters"] = cut(target, subsets)  # type: ignore[arg-type]
            manifest[name]["files"] |= checksums
    write(manifest)


def write(manifest: dict[str, Vendored]) -> None:
    """Write the manifest with letters as people read them."""
    MANIFEST.write_text(json.dumps(manifest, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def update() -> None:
    """Fetch everything that vendor.toml lists and write the manifest."""
    manifest: dict[str, Vendored] = {}
    with tempfile.TemporaryDirectory() as scratch:
        for name, entry in wanted().items():
            package, version = str(entry["package"]), str(entry["version"])
            fetch, inside = SOURCES[str(entry.get("source", "npm"))]
            archive, integrity = fetch(package, version, Path(scratch))
            target = HERE / name / version.rpartition(":")[2]
            files = copy(archive, inside, list(entry["files"]), target)  # type: ignore[call-overload]
            manifest[name] = Vendored(
                package=package,
                version=version,
                licence=str(entry["licence"]),
                integrity=integrity,
                files=files,
            )
    write(manifest)
    recut()


def problems() -> list[str]:
    """Return one sentence for every file that is missing, changed or not listed."""
    manifest: dict[str, Vendored] = json.loads(MANIFEST.read_text())
    found = []
    listed = {path: sum_ for entry in manifest.values() for path, sum_ in entry["files"].items()}
    for path, checksum in listed.items():
        file = HERE / path
        if not file.exists():
            found.append(f"{path} is missing; run vendor.py update.")
        elif digest(file.read_bytes()) != checksum:
            found.append(f"{path} differs from what was fetched; run vendor.py update.")
    for name, entry in wanted().items():
        if manifest.get(name, {}).get("version") != entry["version"]:
            found.append(f"{name} {entry['version']} is not in the manifest; run vendor.py update.")
    folders = [folder for folder in HERE.iterdir() if folder.is_dir() and folder.name != "__pycache__"]
    actual = {
        str(file.relative_to(HERE)) for folder in folders for file in folder.rglob("*") if file.is_file()
    }
    found += [f"{path} is not listed in vendor.toml; remove it." for path in sorted(actual - listed.keys())]
    return found + uncut(manifest)


def uncut(manifest: dict[str, Vendored]) -> list[str]:
    """Return one sentence for every cut font that lacks letters which its language uses."""
    found = []
    for name, entry in wanted().items():
        cut_letters = manifest.get(name, {}).get("letters", {})
        for file, subset in entry.get("subset", {}).items():  # type: ignore[attr-defined]
            has = next((letters for path, letters in cut_letters.items() if Path(path).name == file), "")
            if lacking := "".join(sorted(set(wanted_letters(subset)) - set(has))):
                found.append(f"{file} lacks {lacking}, which pages use; run make translations.")
    return found


def main() -> int:
    """Run `update`, `letters` or `check`."""
    match sys.argv[1:]:
        case ["update"]:
            update()
            return 0
        case ["letters"]:
            recut()
            return 0
        case ["check"]:
            found = problems()
            sys.stdout.write("\n".join(found) + "\n" if found else "Vendored files are as fetched.\n")
            return 1 if found else 0
    sys.stderr.write("Say: vendor.py update | letters | check\n")
    return 2


if __name__ == "__main__":
    sys.exit(main())
