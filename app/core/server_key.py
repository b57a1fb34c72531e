"""The one secret of the service: hand-over codes and the hashes of sign-in codes derive from it."""

import hmac
import os
import secrets
from hashlib import sha256
from pathlib import Path

from app.core.errors import StartError

KEY_BYTES = 32


class ServerKey:
    """Derives by HMAC-SHA256; never shows itself."""

    def __init__(self, key: bytes) -> None:
        self._key = key

    def derive(self, *words: str) -> bytes:
        """32 bytes that only the holder of the key can compute from `words`."""
        return hmac.new(self._key, "\0".join(words).encode(), sha256).digest()


def open_server_key(path: Path) -> ServerKey:
    """Read the key file, or make it (mode 0600) at the first start. Raises StartError."""
    try:
        make_key_file(path, secrets.token_hex(KEY_BYTES))
        key = bytes.fromhex(path.read_text().strip())
    except (OSError, ValueError) as error:
        raise StartError(f"The server key {path} cannot be used: {error}.") from error
    if len(key) != KEY_BYTES or path.stat().st_mode & 0o077:
        raise StartError(
            f"The server key {path} must hold {KEY_BYTES * 2} hex digits and be readable by you alone (0600)."
        )
    return ServerKey(key)


def make_key_file(path: Path, text: str) -> None:
    """Write a key (mode 0600) whole or not at all, never over an existing one: two processes may start at once."""
    if path.exists():
        return
    unfinished = path.with_name(f"{path.name}.{os.getpid()}")
    descriptor = os.open(unfinished, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    try:
        with os.fdopen(descriptor, "w") as file:
            file.write(text)
            file.flush()
            os.fsync(descriptor)
        path.hardlink_to(unfinished)
    except FileExistsError:
        pass
    finally:
        unfinished.unlink()
