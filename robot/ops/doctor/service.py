"""The service: reachable, and this robot's token good. Asking does not disturb a robot that is signed in."""

from urllib.parse import urlsplit

import httpx
from websockets.exceptions import ConnectionClosed, InvalidStatus, WebSocketException
from websockets.sync.client import connect

from maps import CampusMapError, find_map
from robot.core.config import ConfigError, read_token
from robot.link.enrolment import trusted
from robot.ops.doctor.findings import Finding, Subjects, fail, ok, skip, warn

LIMIT_S = 5.0
REFUSAL_WITHIN_S = 1.0
"""A token that is not known is refused at once; one that is known is met with silence until we say hello."""
TOKEN_REFUSED = 4401
NEW_TOKEN = "Enrol again: `python -m app robots enrol NAME` at the service, `python -m robot enrol` here."  # noqa: S105
NO_WAY = "Check the network, the address and the certificate; the robot drives within its grants meanwhile."


def token(patient: Subjects) -> Finding:
    """Check that the service lets this robot in. We never say hello: that would take the place of a running daemon."""
    url = patient.settings.server
    if url is None:
        return skip("no server is set: this robot works alone")
    try:
        secret = read_token(patient.settings.token_file) if patient.settings.token_file else ""
    except ConfigError as problem:
        return fail(str(problem), NEW_TOKEN)
    return asked(url, secret)


def asked(url: str, secret: str) -> Finding:
    """Knock with this token."""
    try:
        header = {"Authorization": f"Bearer {secret}"}
        with connect(url, additional_headers=header, open_timeout=LIMIT_S, close_timeout=1, proxy=None) as socket:
            socket.recv(timeout=REFUSAL_WITHIN_S)
    except TimeoutError as silence:
        if "handshake" in str(silence) or "open" in str(silence):
            return warn(f"{url} does not answer within {LIMIT_S:g} s", NO_WAY)
        return ok(f"{url} takes this robot's token")
    except ConnectionClosed as closed:
        if closed.rcvd and closed.rcvd.code == TOKEN_REFUSED:
            return fail(f"{url} refuses this robot's token", NEW_TOKEN)
        return warn(f"{url} hung up: {closed}", NO_WAY)
    except InvalidStatus as refused:
        if refused.response.status_code in {401, 403}:
            return fail(f"{url} refuses this robot's token", NEW_TOKEN)
        return fail(f"{url} answers {refused.response.status_code}: no robot link is there", "Correct the address.")
    except (OSError, WebSocketException) as error:
        return warn(f"{url} cannot be reached: {error}", NO_WAY)
    return ok(f"{url} takes this robot's token")


def map_version(patient: Subjects) -> Finding:
    """Check whether robot and service mean the same map: another could send the robot into a wall."""
    url = patient.settings.server
    if url is None:
        return skip("no server is set")
    try:
        ours = find_map(patient.settings.map)
        told = httpx.get(map_address(url), timeout=LIMIT_S, verify=trusted()).raise_for_status().json()
        theirs = (str(told["name"]), str(told["version"]))
    except CampusMapError as problem:
        return fail(str(problem), "Set map.")
    except (httpx.HTTPError, ValueError, KeyError, TypeError) as error:
        return skip(f"the service does not tell its map ({type(error).__name__})")
    if theirs == (ours.name, ours.version):
        return ok(f"{ours.name}, version {ours.version}, as at the service")
    said = f"here {ours.name} {ours.version}, at the service {theirs[0]} {theirs[1]}"
    return fail(f"two maps: {said}", "Bring both to the same version of the checkout, and set the same map.")


def map_address(link: str) -> str:
    """Beside the robot link: wss://host/api/v1/robots/link → https://host/api/v1/map."""
    parts = urlsplit(link)
    scheme = "https" if parts.scheme == "wss" else "http"
    return f"{scheme}://{parts.netloc}{parts.path.removesuffix('/robots/link')}/map"
