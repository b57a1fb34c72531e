"""The one secret of the service: hand-over codes and the hashes of sign-in codes derive from it."""

import hmac
import os
import secrets
from hashlib import sha256
from pathlib import Path

from app.errors import StartError

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
        _make_once(path)
        key = bytes.fromhex(path.read_text().strip())
    except (OSError, ValueError) as error:
        raise StartError(f"The server key {path} cannot be used: {error}.") from error
    if len(key) != KEY_BYTES or path.stat().st_mode & 0o077:
        raise StartError(
            f"The server key {path} must hold {KEY_BYTES * 2} hex digits and be readable by you alone (0600)."
        )
    return ServerKey(key)


def _make_once(path: Path) -> None:
    """Whole or not at all, and never over an existing key: two processes may start at the same moment."""
    if path.exists():
        return
    unfinished = path.with_name(f"{path.name}.{os.getpid()}")
    with os.fdopen(os.open(unfinished, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as file:
        file.write(secrets.token_hex(KEY_BYTES))
    try:
        path.hardlink_to(unfinished)
    except FileExistsError:
        pass
    finally:
        unfinished.unlink()
