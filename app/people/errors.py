"""What can be wrong with who somebody says they are.

Unprocessable └── AddressNotAllowed
NotSignedIn   ├── WrongCode
              └── CodeExpired
Forbidden     ├── RoleNeeded
              ├── CrossSite
              └── HttpsRequired
"""

from app.errors import Forbidden, NotSignedIn, Unprocessable


class AddressNotAllowed(Unprocessable):
    """The mail domain is not one of the campus's."""

    code = "address_not_allowed"


class WrongCode(NotSignedIn):
    """A code was mailed and is still good, but this is not it."""

    code = "wrong_code"


class CodeExpired(NotSignedIn):
    """No code that is still good: never asked for, too old, used, or tried too often."""

    code = "code_expired"


class RoleNeeded(Forbidden):
    """Signed in, but without the role that this takes; the sentence names it."""

    code = "role_needed"


class CrossSite(Forbidden):
    """A request that changes something, sent with the cookie by a page that is not ours."""

    code = "cross_site"


class HttpsRequired(Forbidden):
    """Plain http from another machine: a cookie would travel in the open."""

    code = "https_required"
