"""Descriptions of parameters that many routes share, for the API document. A route may have its own."""

from collections.abc import Mapping
from typing import Final

PARAMETERS: Final[Mapping[str, str]] = {
    # headers
    "Accept-Language": "Languages that the caller reads, best first: for a person who has not chosen one.",
    "Authorization": "`Bearer` and a token.",
    "Idempotency-Key": "Chosen by the caller, new for each thing to be done: the same key and body are done once.",
    "If-Match": "An ETag: the change is made only if the order is still at that version.",
    "Last-Event-Id": "The `id` of the last event that was heard: what came after it is told first.",
    "User-Agent": "What the session is called in the list of sessions.",
    # places
    "alarm_id": "An alarm's id.",
    "delegate_id": "Whom the order's person named: the `id` in the list of delegates.",
    "device_id": "A browser that shows notices: its `id`.",
    "email": "A mail address.",
    "file": "A mail's file in the spool.",
    "name": "A robot's name.",
    "corridor": "A corridor, by its two posts as the map names it, such as post2-post3.",
    "order_id": "An order's id.",
    "person_id": "A person's id.",
    "post": "A post's name on the map.",
    "prefix": "A token's readable beginning, without `cmp_`.",
    "role": "What to give or take; in a list of orders: those one sent, those coming to one, or all that one may see.",
    "sending_id": "One notice on one channel, as the outbox lists it.",
    "session_id": "A session's id.",
    "standing_order_id": "A standing order's id.",
    "token_prefix": "A robot token's readable beginning, without `cmr_`.",
    # questions
    "code": "What the campus's sign-in sends back with the browser.",
    "error": "What the campus's sign-in says instead, if it refused the person.",
    "from_post": "Where the mail is fetched: a post's name on the map.",
    "given_up": "Only what is tried no more.",
    "limit": "At most this many items.",
    "state": "What the browser took along to the campus's sign-in.",
    "to_post": "Where the mail is taken: a post's name on the map.",
}
