"""Errors of sign-in, and of changes to people.

Unprocessable ├── AddressNotAllowed
              └── NoSuchPost
NotSignedIn   ├── WrongCode
              ├── CodeExpired
              ├── LinkRefused
              ├── WrongState
              ├── OidcRefused
              ├── OidcUntrusted
              └── EmailNotVerified
Forbidden     ├── RoleNeeded
              ├── ScopeNeeded
              ├── NotForScripts
              ├── CrossSite
              └── HttpsRequired
NotFound      ├── NoCampusSignIn
              ├── UnknownSession
              ├── UnknownToken
              ├── UnknownPerson
              └── UnknownContact
Conflict      └── LastMaintainer
ServiceError  └── ProviderFailed
"""

from app.core.errors import Conflict, Forbidden, NotFound, NotSignedIn, ServiceError, Unprocessable


class AddressNotAllowed(Unprocessable):
    """The mail domain is not one of the campus's."""

    code = "address_not_allowed"


class WrongCode(NotSignedIn):
    """A code was mailed and is still good, but this is not it."""

    code = "wrong_code"


class CodeExpired(NotSignedIn):
    """No code that is still good: never asked for, too old, used, or tried too often."""

    code = "code_expired"


class LinkRefused(NotSignedIn):
    """The link of a mail is unknown, too old or was taken back."""

    code = "link_refused"


class WrongState(NotSignedIn):
    """A browser came back from the provider that was not sent there by us, or too long ago."""

    code = "wrong_state"


class OidcRefused(NotSignedIn):
    """The provider did not let a person in, or did not take the code that they came back with."""

    code = "oidc_refused"


class OidcUntrusted(NotSignedIn):
    """The provider's answer is not to this question, not for this service or not signed by the provider."""

    code = "oidc_untrusted"


class EmailNotVerified(NotSignedIn):
    """The provider knows who it is, but not whether the address is theirs."""

    code = "email_not_verified"


class NoCampusSignIn(NotFound):
    """No identity provider is configured."""

    code = "no_campus_sign_in"


class ProviderFailed(ServiceError):
    """The identity provider cannot be reached, or is not what was configured."""

    status = 502
    code = "provider_failed"


class RoleNeeded(Forbidden):
    """Signed in, but without the role that this takes; the sentence names it."""

    code = "role_needed"


class CrossSite(Forbidden):
    """A request that changes something, sent with the cookie by a page that is not ours."""

    code = "cross_site"


class HttpsRequired(Forbidden):
    """Plain http from another machine: a cookie would travel in the open."""

    code = "https_required"


class ScopeNeeded(Forbidden):
    """A token without the scope that this takes; the sentence names it."""

    code = "scope_needed"


class NotForScripts(Forbidden):
    """A person at a browser does this, no token: making tokens, giving roles, ending sessions, setting webhooks."""

    code = "not_for_scripts"


class NoSuchPost(Unprocessable):
    """The campus map has no such post; the sentence offers the nearest spelling."""

    code = "unknown_post"


class UnknownSession(NotFound):
    """No such session, or not one of this person's."""

    code = "unknown_session"


class UnknownToken(NotFound):
    """No such token, or not one of this person's."""

    code = "unknown_token"


class UnknownPerson(NotFound):
    """No person has this id."""

    code = "unknown_person"


class UnknownContact(NotFound):
    """This address is not saved."""

    code = "unknown_contact"


class LastMaintainer(Conflict):
    """The last maintainer stays one, so that roles can be given."""

    code = "last_maintainer"
