"""What the service takes and answers: made of its OpenAPI document by make_client.py."""

from __future__ import annotations

from datetime import date, datetime
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field


class Model(BaseModel):
    """Frozen; what a newer service says besides is ignored."""

    model_config = ConfigDict(frozen=True, extra="ignore", validate_by_name=True, validate_by_alias=True)


class About(Model):
    """What pages need to know before anybody is signed in."""

    name: str
    version: str
    simulated: bool
    demo: bool
    now: datetime
    languages: list[str]
    allowed_domains: list[str]
    campus_sign_in: bool
    map: str


class AboutMe(Model):
    """What somebody may change about themselves; what is absent stays as it is."""

    name: str | None = None
    language: Literal["en", "fr"] | str | None = None
    usual_post: str | None = None


Activity = Literal["idle", "driving", "waiting", "charging", "stopped"] | str
"""What the robot is doing, in one word."""


class AddressBook(Model):
    """Those with whom mail was exchanged, newest first; then the others who are saved, by label."""

    items: list[ContactView]
    next: str | None


class AlarmPage(Model):
    """Some alarms, newest first."""

    items: list[AlarmView]
    next: str | None


class AlarmView(Model):
    """Something about a robot that a person should look at; over when `cleared_at` says so.

    `reason` is a sentence in English; `why_words` the same as a text of the catalogue, if it is one.
    `corridor`: the one that the robot found closed, and in which it goes nowhere until the alarm is over.
    """

    id: int
    robot: str
    name: str
    reason: str
    why_words: Words | None
    post: str | None
    corridor: str | None
    at: datetime
    cleared_at: datetime | None
    acknowledged_at: datetime | None


class Attention(Model):
    """Why a person has to see to the order."""

    reason: str


class BatteryHistory(Model):
    """What a robot told of its battery, oldest first: at most about 300 samples, those where charging began or
    ended among them. `low_ratio`: below this a robot goes to charge, unless its own settings say otherwise.
    """

    robot: str
    since: datetime
    until: datetime
    low_ratio: float
    samples: list[BatterySampleView]


class BatterySampleView(Model):
    """Charge as a ratio of capacity at one moment, and whether the dock was charging."""

    at: datetime
    ratio: float
    charging: bool


class BatteryView(Model):
    """Charge as a ratio of capacity. `charges_to`: with that it leaves its dock to others; null if it has it."""

    ratio: float
    charging: bool
    charges_to: ChargedView | None


class ChargedView(Model):
    """How much charge a robot that charges is expected to have at about this time. How fast chargers are is
    assumed.
    """

    ratio: float
    at: datetime


class ClosedCorridorView(Model):
    """A corridor into which no robot is let, since when and why: the reason of the person who has closed it, else
    the words of the robot that turned back there.
    """

    corridor: str
    reason: str
    why_words: Words | None
    closed_at: datetime
    by_person: bool
    robots: list[str]


class ClosedCorridors(Model):
    """All of them, by name: it replaces what was known."""

    closed: list[ClosedCorridorView]


class CodeMailed(Model):
    """Until when the mailed code is good."""

    expires_at: datetime


class CodeRequest(Model):
    """Mail me a code."""

    email: str


class CodeView(Model):
    """A hand-over code: `text` as a QR code for the robot's camera, `digits` to be typed in the app."""

    purpose: Literal["load", "receive", "return"] | str
    text: str
    digits: str
    digits_locked: bool
    svg_url: str
    expires_at: datetime


class CommandPage(Model):
    """Some commands of one robot, newest first."""

    items: list[CommandView]
    next: str | None


class CommandReason(Model):
    """Why: the robot keeps it, and whoever reads the log later wants to know."""

    reason: str


class CommandView(Model):
    """What a robot was told, and what became of it: `accepted` null until it answers; `reason` is its own
    sentence, in English, `reason_words` the same as a text of the catalogue, if it is one.

    `online` false: it has not heard of it yet, and will when it is back.
    """

    command_id: str
    robot: str
    kind: str
    order_id: str | None
    asked_at: datetime
    answered_at: datetime | None
    accepted: bool | None
    reason: str | None
    reason_words: Words | None
    online: bool


class ContactView(Model):
    """Somebody one knows. `post` is the saved one, else the one they call their usual post."""

    email: str
    name: str
    label: str
    post: str | None
    saved: bool
    last_mail_at: datetime | None


class ContactWish(Model):
    """What the address book is to say of somebody."""

    label: str = ""
    post: str | None = None


class CorridorView(Model):
    """The line between two posts; `tape` is where it lies, from a to b; `network`: as of a post."""

    name: str
    a: str
    b: str
    length_m: float
    assumed: bool
    network: bool
    tape: list[tuple[float, float]]


class CustodyView(Model):
    """One link of the chain of custody: who held the mail, from when to when (null: to this day).

    `holder` is sender, robot, recipient, delegate or mailroom, `name` the robot's or the delegate's. `how` says
    how they came to have it: code, tap, digits or button by a robot's receipt, `dispatcher` by a dispatcher's
    word, null for the sender's own. `confirmed_by` is whose code, tap or digits it was (null for the button),
    and `confirmed_by_name` which delegate's; `signed`: the robot has signed for it, and the signature was
    checked. A delegate of the other side is a delegate without a name.

    `evidence` says what the link goes by: `proof` (only the code that was shown gives it), `tap`, `digits`,
    `dispatcher`, `digest` (weaker: an older robot), `button`, `claimed` (nothing but the robot's word, so that
    nobody has confirmed it) or `settled` (claimed, and found true since); null for the sender's own. Who is
    said to have mail that is claimed to be out stands last, while the robot answers for it still.
    """

    holder: str
    name: str | None
    from_: datetime = Field(alias="from")
    to: datetime | None
    how: str | None
    confirmed_by: str | None
    confirmed_by_name: str | None
    signed: bool
    evidence: str | None


class DelegateView(Model):
    """Somebody who was named; `revoked_at` null: their code is good still."""

    id: str
    name: str
    email: str | None
    purpose: Literal["load", "receive", "return"] | str
    named_at: datetime
    revoked_at: datetime | None


class Delegates(Model):
    """Who was named for an order, as far as one may see them, oldest first."""

    items: list[DelegateView]
    next: str | None


class DeviceView(Model):
    """A browser that shows notices, and whose push service carries them."""

    id: str
    push_service: str
    created_at: datetime


class DurationView(Model):
    """How long one thing takes: quantiles in seconds, of which `seen` were seen; `assumed_s` by map and settings."""

    kind: Literal["corridor", "load", "receive"] | str
    name: str
    from_post: str | None
    to_post: str | None
    seen: int
    assumed_s: float
    p10_s: float
    p50_s: float
    p90_s: float


class Enrolled(Model):
    """The robot's token, told once and never again."""

    name: str
    token: str


class Enrolment(Model):
    """What a robot comes with: its code, and the public half of its Ed25519 key, in base64."""

    name: str
    code: str
    public_key: str


class EnrolmentCodeView(Model):
    """A one-time code, shown once: type it at the robot before it expires."""

    robot: str
    code: str
    expires_at: datetime


class Estimate(Model):
    """Before ordering: when mail would arrive, and how far it has to go.

    `reason` (and `reason_words`, as a text of the catalogue): why no robot can come as things are. The window
    then only says how long it would take with one.
    """

    window: WindowView
    length_m: float
    assumed: bool = True
    reason: str | None = None
    reason_words: Words | None = None


class EstimateError(Model):
    """One way to estimate. `median_error_ratio`: of the middle, as a share of what it took. `pinball_s`: the mean
    loss of the three quantiles, in seconds; less is better.
    """

    median_error_ratio: float
    pinball_s: float


class EstimateQuality(Model):
    """How good estimated arrivals were: `placed`, as told when an order was placed; `under_way`, as told first
    when a robot had it and first after its mail was loaded, so up to twice for each order.

    `assumed`: people are still told what the lengths on the map say, since too little was seen. `inside_meant`
    is aimed at as `inside_ratio`.
    """

    assumed: bool
    inside_meant: float
    placed: ToldQuality
    under_way: ToldQuality
    durations: list[DurationView]


class EstimateView(Model):
    """The arrival at the recipient's that is expected now.

    `from` and `to` are null while no time is known: an interval that is over is never given. `made_at`: when it
    was worked out. `assumed`: by the map alone, nothing was measured yet. `reason` (and `reason_words`, as a
    text of the catalogue) is what the order waits for; there is always one where no time is known.
    `promised_to` is the end of the window that its people were told; `late`: that is over, or a delay was told
    of.
    """

    from_: datetime | None = Field(alias="from")
    to: datetime | None
    made_at: datetime | None
    assumed: bool
    reason: str | None
    reason_words: Words | None
    promised_to: datetime | None
    late: bool


class EventView(Model):
    """One step of the timeline: when by the server, when by the robot, on whose word, where, why.

    `kind` is `moved` for a change of state; any other says what else happened, such as `wait_extended`.
    """

    seq: int
    kind: str
    state: OrderState
    at: datetime
    robot_at: datetime | None
    by: str
    robot: str | None
    post: str | None
    reason: str | None
    reason_words: Words | None


class Expected(Model):
    """Where it should be seen next, and between which times; never times that are over."""

    post: str
    from_: datetime = Field(alias="from")
    to: datetime


class HandOverWish(Model):
    """Hand over now. Without digits it is a tap of whoever's turn it is."""

    digits: str = ""


class HandoverAsked(Model):
    """The robot is asked, until `expires_at`. Whether mail changes hands, its receipt says."""

    order_id: str
    purpose: Literal["load", "receive", "return"] | str
    how: Literal["tap", "digits"] | str
    at: datetime
    expires_at: datetime


class HandoverRequested(Model):
    """Somebody has tapped or typed digits, and the robot has not answered yet; after `expires_at` it will not."""

    how: str
    at: datetime
    expires_at: datetime


class Inbox(Model):
    """The newest notices first; `unread` counts all, not only those shown."""

    items: list[NoticeView]
    next: str | None
    unread: int


class IntoHands(Model):
    """Somebody has taken the mail out by hand."""

    reason: str | None = None


class LastSeen(Model):
    """The post it was last seen at, the one before, and when."""

    post: str
    previous: str | None
    at: datetime


class Link(Model):
    """What stands behind the # of the link."""

    token: str


class LinkedCode(Model):
    """A hand-over code, with its picture: there is no cookie by which it could be fetched."""

    purpose: Literal["load", "receive", "return"] | str
    text: str
    digits: str
    digits_locked: bool
    expires_at: datetime
    svg: str


class LinkedDelegate(Model):
    """Somebody who takes the mail instead."""

    name: str
    email: str | None = None
    purpose: Literal["load", "receive", "return"] | str | None = None
    token: str


class LinkedDelegateView(Model):
    """Who was named, and the code to be passed on to them."""

    delegate: DelegateView
    code: LinkedCode


class LinkedHandOver(Model):
    """Hand over now: a tap, or the digits of a code that is good now."""

    digits: str = ""
    token: str


class LongerWait(Model):
    """How much longer the robot waits; null: as much as one may ask for at once."""

    extend_s: float | None = None


class MapView(Model):
    """The campus map that the robots use too."""

    name: str
    title: str
    version: str
    note: str
    posts: list[PostView]
    corridors: list[CorridorView]


class MyDelegateView(Model):
    """Somebody whom the caller has named, whose code is good until `expires_at`: the `post` where they meet the
    robot, and for which order.
    """

    id: str
    name: str
    email: str | None
    purpose: Literal["load", "receive", "return"] | str
    post: str
    named_at: datetime
    expires_at: datetime
    order_id: str
    state: OrderState
    description: str | None
    sender: Somebody
    recipient: Somebody
    my_role: Literal["sender", "recipient", "dispatcher"] | str


class MyDelegates(Model):
    """Whom the caller has named for orders that go on, newest first."""

    items: list[MyDelegateView]
    next: str | None


class MyView(Model):
    """Oneself, with what every page shows of it."""

    id: str
    email: str
    name: str
    language: str
    usual_post: str | None
    roles: list[Role]
    unread_notices: int


class NewDelegate(Model):
    """Somebody who hands over instead of the sender or the recipient. `purpose` follows from who names them."""

    name: str
    email: str | None = None
    purpose: Literal["load", "receive", "return"] | str | None = None


class NewDevice(Model):
    """What `PushSubscription.toJSON()` of a browser gives."""

    endpoint: str
    keys: SubscriptionKeys


class NewOrder(Model):
    """What the order form says."""

    from_post: str
    to_post: str
    recipient: str
    description: str | None = None
    priority: Priority = "normal"
    on_behalf_of: str | None = None
    not_before: datetime | None = None


class NewStandingOrder(Model):
    """An order that comes again on some weekdays (0 is Monday) at a local time, until a last local day or for
    ever.
    """

    from_post: str
    to_post: str
    recipient: str
    description: str | None = None
    priority: Priority = "normal"
    on_behalf_of: str | None = None
    weekdays: list[int]
    at: str
    zone: str
    until: date | None = None


class NewTokenView(Model):
    """A token as it is made: the only time that its `token` is shown."""

    prefix: str
    name: str
    scopes: list[Scope]
    created_at: datetime
    expires_at: datetime
    used_at: datetime | None
    token: str


class NewWebhook(Model):
    """Where to."""

    url: str


class NewWebhookView(Model):
    """With the secret that signs what it is sent."""

    url: str
    created_at: datetime
    secret: str


NoticeKind = (
    Literal[
        "accepted",
        "robot_near",
        "robot_here",
        "on_its_way",
        "robot_here_for_you",
        "delivered",
        "not_taken",
        "called_back",
        "at_return",
        "returned",
        "held",
        "delayed",
        "cancelled",
        "expired",
        "attention",
        "alarm",
        "delegated",
        "delegation_over",
    ]
    | str
)
"""The things that people are told; the words are in the catalogues, under `notice.<kind>`."""


class NoticeView(Model):
    """One notice in the reader's language; an alarm has no order. Never holds a hand-over code."""

    id: int
    order_id: str | None
    kind: NoticeKind
    title: str
    body: str
    at: datetime
    read: bool


class NoticesRead(Model):
    """Which notices the person has read."""

    ids: list[int]


class OrderPage(Model):
    """Some orders, newest first; `next` is the cursor of the following page, null on the last."""

    items: list[OrderView]
    next: str | None


OrderState = (
    Literal[
        "queued",
        "assigned",
        "to_sender",
        "at_sender",
        "carrying",
        "at_recipient",
        "delivered",
        "returning",
        "at_return",
        "returned",
        "held",
        "expired",
        "cancelled",
        "attention",
    ]
    | str
)
"""Where an order stands; which may follow which is `app/orders/transitions.py`."""


class OrderView(Model):
    """An order as one person may see it. A delegate sees where it is, and of sender and recipient the names alone.

    `estimate`: when the robot should be at the recipient's, or why that is not known; null once it is there, or
    the mail goes elsewhere. `window` has the same times, or null. `why`: what the order waits for, never
    another order's stop. `passed_on_at_post`: where somebody of the mailroom has taken the mail out of one
    robot for another to carry it on.
    """

    id: str
    state: OrderState
    version: int
    from_post: str
    to_post: str
    sender: Somebody
    recipient: Somebody
    description: str | None
    created_at: datetime
    updated_at: datetime
    window: WindowView | None
    estimate: EstimateView | None = None
    robot: RobotView | None
    why: str | None
    why_words: Words | None
    my_role: Literal["sender", "recipient", "dispatcher", "delegate"] | str
    my_code: Literal["load", "receive", "return"] | str | None
    handover_requested: HandoverRequested | None
    can_cancel: bool
    cancel_requested: bool
    return_requested: bool
    priority: Literal["low", "normal", "high"] | str
    not_before: datetime | None
    wait_until: datetime | None
    return_post: str | None
    passed_on_at_post: str | None
    standing_order_id: str | None
    placed_by: Somebody | None
    custody: list[CustodyView]
    events: list[EventView]


class PassingOn(Model):
    """At which post somebody has taken the mail out of its robot for another one; null: where that was seen last."""

    post: str | None = None
    reason: str | None = None


class PeoplePage(Model):
    """Some people, by mail address."""

    items: list[PersonView]
    next: str | None


class PersonView(Model):
    """A person: oneself, or somebody of the campus as dispatchers and maintainers see them."""

    id: str
    email: str
    name: str
    language: str
    usual_post: str | None
    roles: list[Role]


class PostView(Model):
    """A post of the map; metres, x to the right, y up. `markers`: how many marker sheets hang there; `network`
    false: no robot is heard there.
    """

    name: str
    title: str
    x_m: float
    y_m: float
    dock: bool
    mailroom: bool
    markers: int
    network: bool


Priority = Literal["low", "normal", "high"] | str
"""How much sooner than others an order is fetched."""


class PriorityChange(Model):
    """How much sooner than others it is fetched."""

    priority: Priority


class Reassignment(Model):
    """Which robot shall fetch it; null: any other."""

    robot: str | None = None


class Resolution(Model):
    """What becomes of an order that needed attention: on as before, with mail aboard back or into the mailroom's
    hands, without into the queue again or not at all. `handed_over`: mail that its robot says it has not any
    more, without a proof, is with whoever should have it, who was asked.
    """

    to: Literal["resume", "returning", "held", "queued", "cancelled", "handed_over"] | str
    reason: str | None = None


class RobotDetails(Model):
    """One robot in full. `clock_off_s`: how far its clock is ahead; times shown are put right by it.

    `signs_receipts`: it has a key, so that its receipts are checked. `takes_taps`: hand-overs can be confirmed
    in the app. `alarms` are those that are not over.
    """

    robot: RobotView
    enrolled_at: datetime
    software: str | None
    map_version: str | None
    clock_off_s: float
    signs_receipts: bool
    takes_taps: bool
    alarms: list[AlarmView]


class RobotPage(Model):
    """Some robots, by name; `next` is the cursor of the following page, null on the last."""

    items: list[RobotView]
    next: str | None


class RobotTokenPage(Model):
    """Some tokens of a robot, newest first."""

    items: list[RobotTokenView]
    next: str | None


class RobotTokenView(Model):
    """A token by its readable prefix: when it was made, used last, and taken back."""

    prefix: str
    created_at: datetime
    used_at: datetime | None
    revoked_at: datetime | None


class RobotView(Model):
    """One robot. `online` is its own axis: an offline robot goes on with what it is doing.

    `why` is its own sentence, in English, or the service's while it waits for others; `why_words` the same as a
    text of the catalogue, if it is one. `waits_for`: the facts of that. `taken_out_at`: a person has given its
    corridors to others, and it has not heard so yet.
    """

    name: str
    online: bool
    last_seen: LastSeen | None
    towards: str | None
    expected: Expected | None
    activity: Activity
    battery: BatteryView | None
    why: str | None
    why_words: Words | None
    waits_for: WaitsFor | None
    taken_out_at: datetime | None
    heard_at: datetime | None


Role = Literal["member", "dispatcher", "maintainer"] | str
"""What somebody may do beyond their own orders."""
Scope = (
    Literal[
        "orders:read",
        "orders:write",
        "robots:read",
        "notices:read",
        "notices:write",
        "contacts:read",
        "live:read",
        "dispatch",
        "maintain",
    ]
    | str
)
"""A token does what its scopes allow and its person may do, never more."""


class SendingView(Model):
    """A notice that a channel has not taken yet. Without its contents: who is told what is enough to help."""

    id: int
    channel: str
    kind: str
    email: str
    order_id: str | None
    created_at: datetime
    tries: int
    next_try_at: datetime | None
    gave_up_at: datetime | None
    problem: str | None


class Sendings(Model):
    """Newest first."""

    items: list[SendingView]
    next: str | None


class SessionPage(Model):
    """Some sessions, newest first."""

    items: list[SessionView]
    next: str | None


class SessionView(Model):
    """Where somebody is signed in; `seen_at` is some minutes behind."""

    id: int
    device: str
    created_at: datetime
    seen_at: datetime | None
    expires_at: datetime
    current: bool


class SignIn(Model):
    """The code from the mail."""

    email: str
    code: str


class Somebody(Model):
    """The other person of an order."""

    email: str
    name: str


class SpooledMail(Model):
    """What a mail's head says."""

    name: str
    to: str
    subject: str
    at: datetime


class SpooledMails(Model):
    """The newest mails in the spool."""

    items: list[SpooledMail]


class SpooledText(Model):
    """One of them, with whatever opens something taken out."""

    name: str
    to: str
    subject: str
    at: datetime
    text: str
    attachments: list[str]


class StandingOrderPage(Model):
    """Some standing orders, newest first; `next` is the cursor of the following page, null on the last."""

    items: list[StandingOrderView]
    next: str | None


class StandingOrderView(Model):
    """A standing order. `next_at` is when its next order is made: null while it is paused, and once it has ended."""

    id: str
    from_post: str
    to_post: str
    sender: Somebody
    recipient: Somebody
    description: str | None
    priority: Literal["low", "normal", "high"] | str
    weekdays: list[int]
    at: str
    zone: str
    until: date | None
    created_at: datetime
    next_at: datetime | None
    paused: bool
    ended: bool
    why: str | None


class SubscriptionKeys(Model):
    """The browser's own keys (RFC 8291), URL-safe base64."""

    p256dh: str
    auth: str


class TakenCorridor(Model):
    """A corridor that a robot may be in, in its direction, since it was let in; until the robot says that it is
    out.
    """

    robot: str
    corridor: str
    from_post: str
    to_post: str
    since: datetime


class TokenPage(Model):
    """Some tokens that still open something, newest first."""

    items: list[TokenView]
    next: str | None


class TokenView(Model):
    """A token without its secret."""

    prefix: str
    name: str
    scopes: list[Scope]
    created_at: datetime
    expires_at: datetime
    used_at: datetime | None


class TokenWish(Model):
    """A token for a script of mine."""

    name: str
    scopes: list[Scope]
    days: int = 90


class ToldQuality(Model):
    """How good arrivals were estimated of the latest orders, `scored` in number.

    `inside_ratio` is how often the robot came between the times that were told, `earlier_ratio` and
    `later_ratio` how often before and after them. `by_map`: what the lengths on the map alone would have told
    of the same orders. All of it is null as long as no robot has come.
    """

    scored: int
    inside_ratio: float | None
    earlier_ratio: float | None
    later_ratio: float | None
    told: EstimateError | None
    by_map: EstimateError | None


class Traffic(Model):
    """Every corridor that is taken, by robot, each robot's in the order in which it was granted them."""

    taken: list[TakenCorridor]


class TrialView(Model):
    """What became of a delivery for trial."""

    is_good: bool
    status: int | None
    problem: str | None


class WaitsFor(Model):
    """The corridor that a robot wishes to enter, the robots that have to go on before, and until about when.

    `closed`: by a person, until a person opens it.
    """

    from_post: str
    to_post: str
    robots: list[str]
    until: datetime | None
    closed: bool


class WatchView(Model):
    """`online` false: it is shown when the robot is back. `tells` false: this robot's software knows nothing of
    it.
    """

    robot: str
    online: bool
    tells: bool
    for_s: float


class WayIsOpen(Model):
    """Which corridor is free again: the name that it has on the map."""

    corridor: str


class WebhookView(Model):
    """An address that is told of one's notices."""

    url: str
    created_at: datetime


class WindowView(Model):
    """An arrival interval; `assumed` while speeds are assumed and not learned."""

    from_: datetime = Field(alias="from")
    to: datetime
    assumed: bool


class Wishes(Model):
    """What is not to come on a channel. A channel that is not named stays as it is."""

    muted: dict[str, list[NoticeKind]]


class WishesView(Model):
    """What somebody is told, and where. The inbox has everything; `muted` says what a channel does not carry."""

    language: str
    kinds: list[NoticeKind]
    must_reach: list[NoticeKind]
    muted: dict[str, list[NoticeKind]]
    push_key: str
    devices: list[DeviceView]
    webhook: WebhookView | None


class Words(Model):
    """A text of the catalogue and what fills its gaps: whoever has the catalogue can say it in any language."""

    key: str
    facts: dict[str, str]
