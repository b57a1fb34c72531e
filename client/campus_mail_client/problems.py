"""An exception for each `code` of the service: made of its error classes by make_client.py."""

from collections.abc import Mapping
from typing import Final

from campus_mail_client.errors import Problem


class AddressNotAllowed(Problem):
    """The mail domain is not one of the campus's. (422)"""

    code = "address_not_allowed"


class BadCursor(Problem):
    """The cursor is not the `next` of an earlier answer of this list. (400)"""

    code = "bad_cursor"


class BadRange(Problem):
    """The export would end before it begins. (400)"""

    code = "bad_range"


class BadRequest(Problem):
    """The request contradicts itself. (400)"""

    code = "bad_request"


class BadSubscription(Problem):
    """The keys are not those of a browser's push subscription. (422)"""

    code = "bad_subscription"


class CodeExpired(Problem):
    """No code that is still good: never asked for, too old, used, or tried too often. (401)"""

    code = "code_expired"


class CodesExpired(Problem):
    """The codes of this order are too old; a dispatcher has to see to it. (409)"""

    code = "codes_expired"


class Conflict(Problem):
    """The present state does not allow it. (409)"""

    code = "conflict"


class CrossSite(Problem):
    """A request that changes something, sent with the cookie by a page that is not ours. (403)"""

    code = "cross_site"


class DatabaseAway(Problem):
    """The database is gone, locked or its disk full; Retry-After says when to try again. (503)"""

    code = "database_away"


class DigitsLocked(Problem):
    """Five wrong ones: a dispatcher has to release the digits. The QR code works. (409)"""

    code = "digits_locked"


class DoorClosed(Problem):
    """The simulated robot does not answer, or said no. (409)"""

    code = "door_closed"


class EmailNotVerified(Problem):
    """The provider knows who it is, but not whether the address is theirs. (401)"""

    code = "email_not_verified"


class ForDispatchers(Problem):
    """A member ordered for somebody else, or with high priority. (403)"""

    code = "for_dispatchers"


class Forbidden(Problem):
    """Known who asks; they may not. (403)"""

    code = "forbidden"


class HttpError(Problem):
    """Another refusal of the web server, by its status. (500)"""

    code = "http_error"


class HttpsRequired(Problem):
    """Plain http from another machine: a cookie would travel in the open. (403)"""

    code = "https_required"


class IdempotencyKeyReused(Problem):
    """The Idempotency-Key was used for another body in the last 24 hours. (422)"""

    code = "idempotency_key_reused"


class InvalidRequest(Problem):
    """A field of the body, the path, the query or a header does not fit; `errors` names it. (422)"""

    code = "invalid_request"


class LastMaintainer(Problem):
    """Somebody must be able to give roles. (409)"""

    code = "last_maintainer"


class LinkRefused(Problem):
    """The link of a mail is unknown, too old or was taken back. (401)"""

    code = "link_refused"


class MalformedBody(Problem):
    """The body cannot be read as JSON. (400)"""

    code = "malformed_body"


class MethodNotAllowed(Problem):
    """The path is there; Allow says what can be done with it. (405)"""

    code = "method_not_allowed"


class MetricsNotForYou(Problem):
    """Metrics are for programs on this machine, or for whoever brings the token that the operator has set. (403)"""

    code = "metrics_not_for_you"


class MutedEverywhere(Problem):
    """A robot waits with somebody's mail: one channel at least has to be left for that. (422)"""

    code = "muted_everywhere"


class NoCampusSignIn(Problem):
    """No identity provider is configured. (404)"""

    code = "no_campus_sign_in"


class NoCode(Problem):
    """It is not this person's turn to show a code. (404)"""

    code = "no_code"


class NoEnrolmentCode(Problem):
    """No code for this name is still good: never made, too old, used, or tried too often. (401)"""

    code = "no_enrolment_code"


class NoSuchCorridor(Problem):
    """Corridors are named by their two posts, in the order of the alphabet. (422)"""

    code = "no_such_corridor"


class NoSuchLink(Problem):
    """The link was not made for this demonstration, or is used from another machine. (404)"""

    code = "no_such_link"


class NoSuchPost(Problem):
    """The campus map has no post of this name. (404)"""

    code = "no_such_post"


class NoWay(Problem):
    """Both posts exist, but no corridors join them. (422)"""

    code = "no_way"


class NoWebhook(Problem):
    """This person has no webhook. (404)"""

    code = "no_webhook"


class NotADemonstration(Problem):
    """There is no simulated robot to show anything to. (404)"""

    code = "not_a_demonstration"


class NotCancellable(Problem):
    """Ended already, or waiting for a dispatcher. (409)"""

    code = "not_cancellable"


class NotForScripts(Problem):
    """A person at a browser does this, no token: making tokens, giving roles, ending sessions, setting webhooks.
    (403)
    """

    code = "not_for_scripts"


class NotFound(Problem):
    """Not there; also what is there but not for this person to see, so that nobody can probe for it. (404)"""

    code = "not_found"


class NotInSpool(Problem):
    """There is no such mail in the spool. (404)"""

    code = "not_in_spool"


class NotReady(Problem):
    """The service should get no requests now; `detail` says why. (503)"""

    code = "not_ready"


class NotReassignable(Problem):
    """The mail is aboard, or the order has ended. (409)"""

    code = "not_reassignable"


class NotRecallable(Problem):
    """There is no mail aboard that could turn back, or it is not this person's to call back. (409)"""

    code = "not_recallable"


class NotSignedIn(Problem):
    """No session, or one that has ended or was revoked. (401)"""

    code = "not_signed_in"


class NotWaiting(Problem):
    """No robot is waiting, or not for this person. (409)"""

    code = "not_waiting"


class NotYourTurn(Problem):
    """It is somebody else's turn to hand over, or nobody's. (409)"""

    code = "not_your_turn"


class NotYoursToDelegate(Problem):
    """The sender names who loads or takes back, the recipient who receives, a dispatcher any. (403)"""

    code = "not_yours_to_delegate"


class NothingClaimed(Problem):
    """The robot says that it has this mail still, or nothing: there is no word of it to be believed. (409)"""

    code = "nothing_claimed"


class NothingToPassOn(Problem):
    """Mail changes robots while one is bringing it to its recipient, not before or after. (409)"""

    code = "nothing_to_pass_on"


class NothingToResume(Problem):
    """The order's robot has dropped it: there is nothing to go on with. (409)"""

    code = "nothing_to_resume"


class OidcRefused(Problem):
    """The provider did not let somebody in, or did not take the code that they came back with. (401)"""

    code = "oidc_refused"


class OidcUntrusted(Problem):
    """The provider's answer is not to this question, not for this service or not signed by the provider. (401)"""

    code = "oidc_untrusted"


class OrderChanged(Problem):
    """If-Match names an older version of the order. (412)"""

    code = "order_changed"


class PreconditionFailed(Problem):
    """If-Match names an older version: read it again first. (412)"""

    code = "precondition_failed"


class ProviderFailed(Problem):
    """The identity provider cannot be reached, or is not what was configured. (502)"""

    code = "provider_failed"


class RobotAway(Problem):
    """Until it is back, what is to be said may not hold any more. It tries the way again by itself. (409)"""

    code = "robot_away"


class RobotExists(Problem):
    """Two robots of one name could not be told apart. (409)"""

    code = "robot_exists"


class RobotGoesOn(Problem):
    """Others might meet it: stop it first. (409)"""

    code = "robot_goes_on"


class RobotNameInvalid(Problem):
    """Letters, digits, - and _; at most 64; beginning with a letter or digit. (422)"""

    code = "robot_name_invalid"


class RobotNotThere(Problem):
    """The robot has not arrived yet, or has left. (409)"""

    code = "robot_not_there"


class RobotOffline(Problem):
    """What is tapped does not reach the robot. The QR code works without network. (409)"""

    code = "robot_offline"


class RobotTakesNoTaps(Problem):
    """Its software is older than taps. The QR code works. (409)"""

    code = "robot_takes_no_taps"


class RobotTooOld(Problem):
    """Its software is older than this message. It tries the way again by itself. (409)"""

    code = "robot_too_old"


class RoleNeeded(Problem):
    """Signed in, but without the role that this takes; the sentence names it. (403)"""

    code = "role_needed"


class SamePost(Problem):
    """From and to are the same post: nothing to carry. (422)"""

    code = "same_post"


class ScopeNeeded(Problem):
    """A token without the scope that this takes; the sentence names it. (403)"""

    code = "scope_needed"


class SentAlready(Problem):
    """It has gone out: sending it again would tell somebody twice. (409)"""

    code = "sent_already"


class StandingOrderEnded(Problem):
    """A standing order that has ended does not come round again: make a new one. (409)"""

    code = "standing_order_ended"


class StillRunning(Problem):
    """The first request with this Idempotency-Key has not ended yet. (409)"""

    code = "still_running"


class TargetRefused(Problem):
    """Not https, not at a port that is allowed, not resolved, or not an address of the public network. (422)"""

    code = "target_refused"


class TooLarge(Problem):
    """The body is larger than 64 KiB. (413)"""

    code = "too_large"


class TooLateToDelegate(Problem):
    """The hand-over that the delegate would do is over. (409)"""

    code = "too_late_to_delegate"


class TooManyDelegates(Problem):
    """One order has room for ten at a time. (409)"""

    code = "too_many_delegates"


class TooManyRequests(Problem):
    """More often than is allowed; Retry-After says when to come back. (429)"""

    code = "too_many_requests"


class TransitionRefused(Problem):
    """The table of transitions does not allow this step, or not on this word. (409)"""

    code = "transition_refused"


class Unforeseen(Problem):
    """A mistake of the service; it is in its log. (500)"""

    code = "unforeseen"


class UnknownAlarm(Problem):
    """No alarm of this number has rung. (404)"""

    code = "unknown_alarm"


class UnknownContact(Problem):
    """This address is not saved. (404)"""

    code = "unknown_contact"


class UnknownDelegate(Problem):
    """This order has no such delegate, or it is not this person's to see. (404)"""

    code = "unknown_delegate"


class UnknownDevice(Problem):
    """No such device, or not one of this person's. (404)"""

    code = "unknown_device"


class UnknownOrder(Problem):
    """No such order, or not one of this person's. (404)"""

    code = "unknown_order"


class UnknownPerson(Problem):
    """Nobody has this id. (404)"""

    code = "unknown_person"


class UnknownPost(Problem):
    """The campus map has no such post; the sentence offers the nearest spelling. (422)"""

    code = "unknown_post"


class UnknownRecipient(Problem):
    """Nobody with this address is known, and its domain is not the campus's. (422)"""

    code = "unknown_recipient"


class UnknownRobot(Problem):
    """Enrol it first. (404)"""

    code = "unknown_robot"


class UnknownRobotToken(Problem):
    """This robot has no such token. (404)"""

    code = "unknown_robot_token"


class UnknownSender(Problem):
    """Nobody with the address of `on_behalf_of` is known, and its domain is not the campus's. (422)"""

    code = "unknown_sender"


class UnknownSending(Problem):
    """Nothing in the outbox has this number. (404)"""

    code = "unknown_sending"


class UnknownSession(Problem):
    """No such session, or not one of this person's. (404)"""

    code = "unknown_session"


class UnknownStandingOrder(Problem):
    """No such standing order, or not one of this person's. (404)"""

    code = "unknown_standing_order"


class UnknownToken(Problem):
    """No such token, or not one of this person's. (404)"""

    code = "unknown_token"


class Unprocessable(Problem):
    """Well formed, yet it cannot be fulfilled. (422)"""

    code = "unprocessable"


class UnsupportedMediaType(Problem):
    """Bodies are taken as application/json alone. (415)"""

    code = "unsupported_media_type"


class WaitedLongEnough(Problem):
    """The robot's other passengers are waiting, too. (409)"""

    code = "waited_long_enough"


class WrongCode(Problem):
    """A code was mailed and is still good, but this is not it. (401)"""

    code = "wrong_code"


class WrongDigits(Problem):
    """They are of no code that is good now; the sentence says how many tries are left. (422)"""

    code = "wrong_digits"


class WrongEnrolmentCode(Problem):
    """A code was made for this name and is still good, but this is not it. (401)"""

    code = "wrong_enrolment_code"


class WrongState(Problem):
    """Somebody came back from the provider who was not sent there by this browser, or too long ago. (401)"""

    code = "wrong_state"


BY_CODE: Final[Mapping[str, type[Problem]]] = {
    "address_not_allowed": AddressNotAllowed,
    "bad_cursor": BadCursor,
    "bad_range": BadRange,
    "bad_request": BadRequest,
    "bad_subscription": BadSubscription,
    "code_expired": CodeExpired,
    "codes_expired": CodesExpired,
    "conflict": Conflict,
    "cross_site": CrossSite,
    "database_away": DatabaseAway,
    "digits_locked": DigitsLocked,
    "door_closed": DoorClosed,
    "email_not_verified": EmailNotVerified,
    "for_dispatchers": ForDispatchers,
    "forbidden": Forbidden,
    "http_error": HttpError,
    "https_required": HttpsRequired,
    "idempotency_key_reused": IdempotencyKeyReused,
    "invalid_request": InvalidRequest,
    "last_maintainer": LastMaintainer,
    "link_refused": LinkRefused,
    "malformed_body": MalformedBody,
    "method_not_allowed": MethodNotAllowed,
    "metrics_not_for_you": MetricsNotForYou,
    "muted_everywhere": MutedEverywhere,
    "no_campus_sign_in": NoCampusSignIn,
    "no_code": NoCode,
    "no_enrolment_code": NoEnrolmentCode,
    "no_such_corridor": NoSuchCorridor,
    "no_such_link": NoSuchLink,
    "no_such_post": NoSuchPost,
    "no_way": NoWay,
    "no_webhook": NoWebhook,
    "not_a_demonstration": NotADemonstration,
    "not_cancellable": NotCancellable,
    "not_for_scripts": NotForScripts,
    "not_found": NotFound,
    "not_in_spool": NotInSpool,
    "not_ready": NotReady,
    "not_reassignable": NotReassignable,
    "not_recallable": NotRecallable,
    "not_signed_in": NotSignedIn,
    "not_waiting": NotWaiting,
    "not_your_turn": NotYourTurn,
    "not_yours_to_delegate": NotYoursToDelegate,
    "nothing_claimed": NothingClaimed,
    "nothing_to_pass_on": NothingToPassOn,
    "nothing_to_resume": NothingToResume,
    "oidc_refused": OidcRefused,
    "oidc_untrusted": OidcUntrusted,
    "order_changed": OrderChanged,
    "precondition_failed": PreconditionFailed,
    "provider_failed": ProviderFailed,
    "robot_away": RobotAway,
    "robot_exists": RobotExists,
    "robot_goes_on": RobotGoesOn,
    "robot_name_invalid": RobotNameInvalid,
    "robot_not_there": RobotNotThere,
    "robot_offline": RobotOffline,
    "robot_takes_no_taps": RobotTakesNoTaps,
    "robot_too_old": RobotTooOld,
    "role_needed": RoleNeeded,
    "same_post": SamePost,
    "scope_needed": ScopeNeeded,
    "sent_already": SentAlready,
    "standing_order_ended": StandingOrderEnded,
    "still_running": StillRunning,
    "target_refused": TargetRefused,
    "too_large": TooLarge,
    "too_late_to_delegate": TooLateToDelegate,
    "too_many_delegates": TooManyDelegates,
    "too_many_requests": TooManyRequests,
    "transition_refused": TransitionRefused,
    "unforeseen": Unforeseen,
    "unknown_alarm": UnknownAlarm,
    "unknown_contact": UnknownContact,
    "unknown_delegate": UnknownDelegate,
    "unknown_device": UnknownDevice,
    "unknown_order": UnknownOrder,
    "unknown_person": UnknownPerson,
    "unknown_post": UnknownPost,
    "unknown_recipient": UnknownRecipient,
    "unknown_robot": UnknownRobot,
    "unknown_robot_token": UnknownRobotToken,
    "unknown_sender": UnknownSender,
    "unknown_sending": UnknownSending,
    "unknown_session": UnknownSession,
    "unknown_standing_order": UnknownStandingOrder,
    "unknown_token": UnknownToken,
    "unprocessable": Unprocessable,
    "unsupported_media_type": UnsupportedMediaType,
    "waited_long_enough": WaitedLongEnough,
    "wrong_code": WrongCode,
    "wrong_digits": WrongDigits,
    "wrong_enrolment_code": WrongEnrolmentCode,
    "wrong_state": WrongState,
}
