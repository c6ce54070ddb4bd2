"""A quick hash that counts how often it was asked."""

import hashlib


class FakeHasher:
    """Makes and checks hashes as argon2 does, without its slowness."""

    def __init__(self) -> None:
        self.made = 0
        self.checked = 0

    def hash(self, password: str) -> str:
        self.made += 1
        return "fake$" + hashlib.sha256(password.encode()).hexdigest()

    def verify(self, password_hash: str, password: str) -> bool:
        self.checked += 1
        return password_hash == "fake$" + hashlib.sha256(password.encode()).hexdigest()
