"""A real OpenID Connect provider in a process of its own (oidc-provider-mock)."""

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import httpx
import pytest

from app.cli.serving import listen


@contextmanager
def campus_provider() -> Iterator[str]:
    """Its issuer. It lets anybody in whom it was told of, at one click."""
    with listen("127.0.0.1", 0) as free:
        port = free.getsockname()[1]
    command = [sys.executable, "-W", "ignore", "-m", "oidc_provider_mock", "--port", str(port)]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        issuer = f"http://127.0.0.1:{port}"
        try:
            _wait_for(issuer)
            yield issuer
        finally:
            process.terminate()


def _wait_for(url: str) -> None:
    for _ in range(300):
        try:
            httpx.get(url)
        except httpx.TransportError:
            time.sleep(0.1)
        else:
            return
    pytest.fail("the provider does not start")


def tell_of(issuer: str, subject: str, **claims: Any) -> None:
    """Tell the provider the claims it makes about a person."""
    httpx.put(f"{issuer}/users/{subject}", json=claims).raise_for_status()
