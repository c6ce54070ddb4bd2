"""Certificates of one's own: an authority that tablets trust once, and the panel's, signed by it.

The time at which one is made may be wrong. An authority is valid from before this software was built, and
none ends earlier than it would if it had been made then.
"""

import ipaddress
import os
import socket
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime, timedelta
from enum import StrEnum
from pathlib import Path

from cryptography import x509
from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from app.base.build import BUILT_AT

AUTHORITY, AUTHORITY_KEY = "ca.crt", "ca.key"
SERVER, SERVER_KEY = "server.crt", "server.key"
AUTHORITY_DAYS = 3650
SERVER_DAYS = 397
"""Longer ones are refused by some browsers."""

RENEW_WITHIN = timedelta(days=30)
EARLIER = timedelta(days=1)
PRIVATE, READABLE = 0o600, 0o644

Key = ec.EllipticCurvePrivateKey


class Validity(StrEnum):
    """Whether browsers take a certificate for valid."""

    VALID = "valid"
    EARLY = "not_yet_valid"
    ENDS = "ends_soon"
    ENDED = "expired"


@dataclass(frozen=True, slots=True)
class Certified:
    """What a certificate says: for which names, from when until when, and its SHA-256 fingerprint."""

    names: tuple[str, ...]
    not_before: datetime
    not_after: datetime
    fingerprint: str

    def validity(self, now: datetime) -> Validity:
        """Return whether it is valid; `ENDS` from 30 days before its end."""
        if now < self.not_before:
            return Validity.EARLY
        if now >= self.not_after:
            return Validity.ENDED
        return Validity.ENDS if self.not_after - now <= RENEW_WITHIN else Validity.VALID


def init(folder: Path, names: Iterable[str], now: datetime) -> Certified:
    """Write a new certificate of the panel for these names; the authority that signs it, too, if missing.

    Its key stays, so that the two fit at every instant: a panel that starts in between is served.
    """
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    authority, signing = _authority(folder, now)
    key = _kept_key(folder / SERVER_KEY) or ec.generate_private_key(ec.SECP256R1())
    _write_private(folder / SERVER_KEY, _pem_of_key(key))
    return _certify(folder, authority, signing, key, tuple(dict.fromkeys(names)), now)


def is_own(folder: Path) -> bool:
    """Return whether the panel's certificate was signed by the authority beside it, whose key is there."""
    try:
        authority, _ = _stored_authority(folder)
        _load(folder / SERVER).verify_directly_issued_by(authority)
    except (OSError, ValueError, TypeError, InvalidSignature):
        return False
    return True


def renew(folder: Path, now: datetime) -> Certified:
    """Write the panel's certificate anew, for the same names; raise `OSError` or `ValueError`.

    Authority and key stay, so that tablets trust it, and certificate and key fit at every instant.
    """
    authority, signing = _stored_authority(folder)
    return _certify(folder, authority, signing, _key(folder / SERVER_KEY), read(folder / SERVER).names, now)


def _certify(
    folder: Path, authority: x509.Certificate, signing: Key, key: Key, names: tuple[str, ...], now: datetime
) -> Certified:
    certificate = _server_certificate(authority, signing, key, names, now)
    chain = b"".join(one.public_bytes(serialization.Encoding.PEM) for one in (certificate, authority))
    _put(folder / SERVER, chain)
    return read(folder / SERVER)


def read(path: Path) -> Certified:
    """Return what the first certificate of a file says, or raise `OSError` or `ValueError`."""
    found = _load(path)
    begin, end = found.not_valid_before_utc, found.not_valid_after_utc
    return Certified(_names(found), begin, end, _fingerprint(found))


def _load(path: Path) -> x509.Certificate:
    return x509.load_pem_x509_certificate(path.read_bytes())


def _key(path: Path) -> Key:
    key = serialization.load_pem_private_key(path.read_bytes(), password=None)
    if not isinstance(key, ec.EllipticCurvePrivateKey):
        raise ValueError(f"{path} is not a key that `heliopanel tls init` made. Remove {path.parent}.")
    return key


def _kept_key(path: Path) -> Key | None:
    """Return a key that can be used, None where there is none."""
    try:
        return _key(path)
    except (OSError, ValueError, TypeError):
        return None


def _stored_authority(folder: Path) -> tuple[x509.Certificate, Key]:
    return _load(folder / AUTHORITY), _key(folder / AUTHORITY_KEY)


def _authority(folder: Path, now: datetime) -> tuple[x509.Certificate, Key]:
    certificate_path, key_path = folder / AUTHORITY, folder / AUTHORITY_KEY
    if certificate_path.exists() and key_path.exists():
        return _stored_authority(folder)
    key = ec.generate_private_key(ec.SECP256R1())
    subject = _subject(f"Heliopanel authority of {socket.gethostname()}"[:64])
    made = (
        _builder(subject, subject, key.public_key(), min(now, BUILT_AT), _end(now, AUTHORITY_DAYS))
        .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
        .add_extension(_usage(signs=True), critical=True)
        .sign(key, hashes.SHA256())
    )
    _write_private(key_path, _pem_of_key(key))
    _put(certificate_path, made.public_bytes(serialization.Encoding.PEM))
    return made, key


def _server_certificate(
    authority: x509.Certificate, signing: Key, key: Key, names: tuple[str, ...], now: datetime
) -> x509.Certificate:
    return (
        _builder(
            _subject(names[0][:64]),
            authority.subject,
            key.public_key(),
            max(now, BUILT_AT),
            _end(now, SERVER_DAYS),
        )
        .add_extension(x509.SubjectAlternativeName([_general(name) for name in names]), critical=False)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(_usage(signs=False), critical=True)
        .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
        .add_extension(
            x509.AuthorityKeyIdentifier.from_issuer_public_key(signing.public_key()), critical=False
        )
        .sign(signing, hashes.SHA256())
    )


def _builder(
    subject: x509.Name, issuer: x509.Name, public: ec.EllipticCurvePublicKey, begin: datetime, end: datetime
) -> x509.CertificateBuilder:
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(public)
        .serial_number(x509.random_serial_number())
        .not_valid_before(begin - EARLIER)
        .not_valid_after(end)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(public), critical=False)
    )


def _end(now: datetime, days: int) -> datetime:
    return max(now, BUILT_AT) + timedelta(days=days)


def _usage(*, signs: bool) -> x509.KeyUsage:
    return x509.KeyUsage(
        digital_signature=not signs,
        key_cert_sign=signs,
        crl_sign=signs,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        encipher_only=False,
        decipher_only=False,
    )


def _subject(name: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, name)])


def _general(name: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(name))
    except ValueError:
        return x509.DNSName(name)


def _names(certificate: x509.Certificate) -> tuple[str, ...]:
    try:
        found = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except x509.ExtensionNotFound:
        return ()
    return tuple(str(one.value) for one in found)


def _fingerprint(certificate: x509.Certificate) -> str:
    text = certificate.fingerprint(hashes.SHA256()).hex().upper()
    return ":".join(text[at : at + 2] for at in range(0, len(text), 2))


def _pem_of_key(key: Key) -> bytes:
    return key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )


def _write_private(path: Path, content: bytes) -> None:
    """Write a file that only its owner may read, from its first byte on."""
    unfinished = path.with_name(f"{path.name}.unfinished")
    unfinished.unlink(missing_ok=True)
    descriptor = os.open(unfinished, os.O_WRONLY | os.O_CREAT | os.O_EXCL, PRIVATE)
    _finish(descriptor, content, unfinished, path)


def _put(path: Path, content: bytes) -> None:
    unfinished = path.with_name(f"{path.name}.unfinished")
    descriptor = os.open(unfinished, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, READABLE)
    _finish(descriptor, content, unfinished, path)


def _finish(descriptor: int, content: bytes, unfinished: Path, path: Path) -> None:
    """Write all of it to the disk before it takes the place of what was there."""
    with os.fdopen(descriptor, "wb") as file:
        file.write(content)
        file.flush()
        os.fsync(descriptor)
    unfinished.replace(path)
