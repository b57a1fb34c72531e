"""The robot's own key: receipts are signed with it, so that only this robot can say that it handed mail over.

Ed25519, made at enrolment; the private half never leaves the robot, the service keeps the public one.
"""

import base64
import stat
from collections.abc import Callable
from pathlib import Path

from cryptography.exceptions import UnsupportedAlgorithm
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat, load_pem_private_key

from protocol.to_server import HandoverReceipt
from robot.core.config import ConfigError

_WAY_OUT = "Enrol this robot again: python -m robot enrol NAME SERVER."


def new_key() -> tuple[str, str]:
    """A key as PEM, for a file of its own, and its public half as base64, for the service."""
    key = Ed25519PrivateKey.generate()
    pem = key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())
    return pem.decode("ascii"), base64.b64encode(key.public_key().public_bytes_raw()).decode("ascii")


def signer(path: Path, robot: str) -> Callable[[HandoverReceipt], HandoverReceipt]:
    """Return a function that puts this robot's signature under a receipt. Raises ConfigError."""
    key = _read(path)

    def sign(receipt: HandoverReceipt) -> HandoverReceipt:
        signature = base64.b64encode(key.sign(receipt.signed_by(robot))).decode("ascii")
        return receipt.model_copy(update={"signature": signature})

    return sign


def _read(path: Path) -> Ed25519PrivateKey:
    try:
        mode = stat.S_IMODE(path.stat().st_mode)
        key = load_pem_private_key(path.read_bytes(), password=None)
    except (OSError, ValueError, TypeError, UnsupportedAlgorithm) as error:
        reason = getattr(error, "strerror", None) or "it holds no key"
        raise ConfigError(str(path), "key_file", f"cannot be read: {reason}", _WAY_OUT) from None
    if mode & 0o077:
        raise ConfigError(str(path), "key_file", f"others may read it (mode {mode:04o})", f"Run: chmod 600 {path}")
    if not isinstance(key, Ed25519PrivateKey):
        raise ConfigError(str(path), "key_file", "is no Ed25519 key", _WAY_OUT)
    return key
