"""Signing in at the campus itself: OpenID Connect, authorization code with PKCE.

State, nonce and the code verifier derive from the server key and one random id, which travels in a signed cookie for
ten minutes: nothing is stored for a sign-in that only begins.
"""

import base64
import hmac
import secrets
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Any, Final

import httpx
import structlog
from authlib.integrations.base_client import OAuthError
from authlib.integrations.httpx_client import AsyncOAuth2Client
from authlib.oidc.core import CodeIDToken
from joserfc import jwt
from joserfc.errors import JoseError
from joserfc.jwk import KeySet
from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.errors import (
    AddressNotAllowed,
    EmailNotVerified,
    OidcRefused,
    OidcUntrusted,
    ProviderFailed,
    WrongState,
)
from app.accounts.schemas import EMAIL
from app.accounts.sign_in.service import SignInService, is_allowed, name_from
from app.core.http_client import trusted_here
from app.core.server_key import ServerKey
from app.core.settings import Settings
from app.core.text_lines import LONGEST_NAME
from app.models import Identity, Person
from protocol.one_line import one_line

log = structlog.get_logger(__name__)

ALGORITHMS: Final = (
    "RS256",
    "RS384",
    "RS512",
    "PS256",
    "PS384",
    "PS512",
    "ES256",
    "ES384",
    "ES512",
    "EdDSA",
    "Ed25519",
)
"""None with a shared key: a holder of the client's secret could sign as the provider."""
LIFETIME: Final = timedelta(minutes=10)
LEEWAY_S: Final = 60
TIMEOUT_S: Final = 10.0
PROVIDER_FAILED: Final = "The campus's sign-in does not answer as it should. Try again, or sign in by a mailed code."


@dataclass(frozen=True)
class Attempt:
    """One way to the provider and back, as the browser's cookie holds it."""

    key: ServerKey
    id: str
    expires_s: int

    @classmethod
    def begin(cls, key: ServerKey, now: datetime) -> "Attempt":
        return cls(key, secrets.token_hex(16), int((now + LIFETIME).timestamp()))

    @classmethod
    def of_cookie(cls, key: ServerKey, cookie: str, now: datetime) -> "Attempt":
        """Raises WrongState for a cookie that is not ours, or too old."""
        attempt_id, _, rest = cookie.partition(".")
        expires_s = rest.partition(".")[0]
        attempt = cls(key, attempt_id, int(expires_s) if expires_s.isdecimal() and len(expires_s) < 16 else 0)
        if not hmac.compare_digest(attempt.cookie.encode(), cookie.encode()) or attempt.expires_s <= now.timestamp():
            raise WrongState("This sign-in began elsewhere or too long ago. Begin again.")
        return attempt

    @property
    def cookie(self) -> str:
        return f"{self.id}.{self.expires_s}.{self._derived(f'cookie.{self.expires_s}')}"

    @property
    def state(self) -> str:
        return self._derived("state")

    @property
    def nonce(self) -> str:
        return self._derived("nonce")

    @property
    def verifier(self) -> str:
        return self._derived("verifier")

    def _derived(self, what: str) -> str:
        return base64.urlsafe_b64encode(self.key.derive("oidc", what, self.id)).decode().rstrip("=")


@dataclass(frozen=True)
class Claims:
    """The claims about a person, on the provider's word."""

    subject: str
    email: str
    name: str


@dataclass
class Provider:
    """The campus's identity provider. What it says of itself is asked once, its keys again when a new one appears."""

    settings: Settings
    key: ServerKey
    _about: dict[str, Any] = field(default_factory=dict)
    _keys: KeySet | None = None

    @property
    def is_configured(self) -> bool:
        return bool(self.settings.oidc_issuer)

    async def address_to_ask(self, attempt: Attempt, redirect_uri: str) -> str:
        """Where the browser is sent to. Raises ProviderFailed."""
        about = await self.about()
        async with self._client(redirect_uri) as client:
            url, _ = client.create_authorization_url(
                about["authorization_endpoint"],
                state=attempt.state,
                nonce=attempt.nonce,
                code_verifier=attempt.verifier,
            )
        return str(url)

    async def claims(self, attempt: Attempt, code: str, redirect_uri: str) -> Claims:
        """Exchange the code, and check every word of the answer. Raises OidcRefused, OidcUntrusted, ProviderFailed."""
        about = await self.about()
        async with self._client(redirect_uri) as client:
            try:
                token = await client.fetch_token(
                    about["token_endpoint"], code=code, code_verifier=attempt.verifier, grant_type="authorization_code"
                )
            except OAuthError as error:
                log.warning("sign-in refused by the provider", problem=str(error.error)[:100])
                raise OidcRefused("The campus's sign-in did not accept this. Begin again.") from None
            except Exception as error:  # whichever HTTP library Authlib found has errors of its own
                raise _failed(error) from None
        said = await self._checked(token, attempt.nonce)
        return _claims(said if "email" in said else await self._userinfo(token, said))

    def _client(self, redirect_uri: str) -> AsyncOAuth2Client:
        return AsyncOAuth2Client(
            self.settings.oidc_client_id,
            self.settings.oidc_client_secret.get_secret_value(),
            scope="openid email profile",
            redirect_uri=redirect_uri,
            code_challenge_method="S256",
            timeout=TIMEOUT_S,
            verify=trusted_here(),
        )

    async def about(self) -> dict[str, Any]:
        """The discovery document. Raises ProviderFailed."""
        if not self._about:
            issuer = self.settings.oidc_issuer
            about = await _read(f"{issuer.rstrip('/')}/.well-known/openid-configuration")
            if about.get("issuer") != issuer:
                log.error("the provider calls itself another", wanted=issuer, says=str(about.get("issuer"))[:200])
                raise ProviderFailed(PROVIDER_FAILED)
            self._about = about
        return self._about

    async def _checked(self, token: dict[str, Any], nonce: str) -> dict[str, Any]:
        """The claims of the ID token: signature, issuer, audience, times, nonce. Raises OidcUntrusted."""
        try:
            decoded = await self._decoded(str(token.get("id_token", "")))
            options = {"iss": {"value": self.settings.oidc_issuer}, "aud": {"value": self.settings.oidc_client_id}}
            params = {"nonce": nonce, "client_id": self.settings.oidc_client_id, **_access_token(token)}
            claims = CodeIDToken(decoded.claims, decoded.header, options, params)
            claims.validate(leeway=LEEWAY_S)
        except (JoseError, ValueError) as error:
            log.warning("sign-in refused: bad token of the provider", problem=f"{type(error).__name__}"[:100])
            raise OidcUntrusted("The campus's sign-in sent an answer that does not fit. Begin again.") from None
        return dict(claims)

    async def _decoded(self, id_token: str) -> jwt.Token:
        if self._keys is not None:
            try:
                return jwt.decode(id_token, self._keys, algorithms=ALGORITHMS)
            except (JoseError, ValueError):
                pass  # perhaps signed with a key that the provider has made since
        about = await self.about()
        self._keys = KeySet.import_key_set(await _read(about["jwks_uri"]))  # type: ignore[arg-type]
        return jwt.decode(id_token, self._keys, algorithms=ALGORITHMS)

    async def _userinfo(self, token: dict[str, Any], said: dict[str, Any]) -> dict[str, Any]:
        """Some providers tell the address only here. Raises OidcUntrusted, ProviderFailed."""
        address = (await self.about()).get("userinfo_endpoint")
        more = await _read(address, token.get("access_token", "")) if address else {}
        if more and more.get("sub") != said["sub"]:
            raise OidcUntrusted("The campus's sign-in speaks of two people. Begin again.")
        return {**more, **said}


def _access_token(token: dict[str, Any]) -> dict[str, Any]:
    return {"access_token": token["access_token"]} if "access_token" in token else {}


async def _read(address: str, bearer: str = "") -> dict[str, Any]:
    headers = {"Authorization": f"Bearer {bearer}"} if bearer else {}
    try:
        async with httpx.AsyncClient(timeout=TIMEOUT_S, verify=trusted_here()) as client:
            answer = await client.get(address, headers=headers)
            answer.raise_for_status()
            said: dict[str, Any] = answer.json()
    except (httpx.HTTPError, httpx.InvalidURL, ValueError) as error:
        raise _failed(error) from None
    return said


def _failed(error: Exception) -> ProviderFailed:
    log.error("the provider does not answer as it should", problem=type(error).__name__)
    return ProviderFailed(PROVIDER_FAILED)


def _claims(said: dict[str, Any]) -> Claims:
    """Only an address that the provider has verified identifies a person. Raises EmailNotVerified."""
    email = str(said.get("email", "")).lower()
    if said.get("email_verified") is not True or not EMAIL.fullmatch(email):
        raise EmailNotVerified("The campus has not verified your mail address. Sign in by a mailed code.")
    return Claims(str(said["sub"])[:255], email, one_line(str(said.get("name", ""))).strip()[:LONGEST_NAME])


async def person_of(session: AsyncSession, desk: SignInService, claims: Claims, language: str, now: datetime) -> Person:
    """Return the person of these claims: known by issuer and subject, else by the verified address. Raises
    AddressNotAllowed."""
    settings = desk.settings
    if not is_allowed(claims.email, settings):
        raise AddressNotAllowed(f"Sign in with an address of {', '.join(settings.allowed_domains)}.")
    known = await session.get(Identity, (settings.oidc_issuer, claims.subject))
    if known is not None:
        return await session.get_one(Person, known.person_id)
    person = await desk.newcomer(session, claims.email, language, now)
    if claims.name and person.name == name_from(person.email):  # the guess that we made
        person.name = claims.name
    session.add(Identity(issuer=settings.oidc_issuer, subject=claims.subject, person_id=person.id, created_at=now))
    await session.flush()
    return person
