"""The key by which push services know this service (VAPID, RFC 8292), made at the first start."""

import base64
from datetime import datetime, timedelta
from pathlib import Path
from typing import Final

from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import ec
from py_vapid import Vapid02

from app.core.errors import StartError
from app.core.server_key import make_key_file

GOOD_FOR: Final = timedelta(hours=12)
"""Of the 24 h that a push service accepts at most."""


class PushKey:
    """Signs what is sent to push services; browsers are given `public` when they subscribe."""

    def __init__(self, key: ec.EllipticCurvePrivateKey) -> None:
        self._vapid = Vapid02(key)
        point = key.public_key().public_bytes(serialization.Encoding.X962, serialization.PublicFormat.UncompressedPoint)
        self.public = base64.urlsafe_b64encode(point).rstrip(b"=").decode()

    def authorization(self, origin: str, contact: str, now: datetime) -> str:
        """The header for a push service at `origin`; `contact` is whom it may write to."""
        claims = {"aud": origin, "sub": contact, "exp": round((now + GOOD_FOR).timestamp())}
        return str(self._vapid.sign(claims)["Authorization"])


def open_push_key(path: Path) -> PushKey:
    """Read the key, or make it (mode 0600) at the first start. Raises StartError."""
    try:
        if not path.exists():
            make_key_file(path, _new_key())
        key = serialization.load_pem_private_key(path.read_bytes(), None)
    except (OSError, ValueError, TypeError) as error:
        raise StartError(f"The push key {path} cannot be used: {error}.") from error
    if not isinstance(key, ec.EllipticCurvePrivateKey) or key.curve.name != "secp256r1" or path.stat().st_mode & 0o077:
        raise StartError(f"The push key {path} must be a P-256 key (PEM) that only you can read (0600).")
    return PushKey(key)


def _new_key() -> str:
    pem = ec.generate_private_key(ec.SECP256R1()).private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    return pem.decode()
