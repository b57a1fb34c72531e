"""One method for each operation: made of the service's OpenAPI document by make_client.py."""

from datetime import datetime
from typing import Any, Literal
from urllib.parse import quote

from campus_mail_client.models import (
    About,
    AboutMe,
    AddressBook,
    AlarmPage,
    AlarmView,
    Attention,
    BatteryHistory,
    ClosedCorridors,
    CodeMailed,
    CodeRequest,
    CodeView,
    CommandPage,
    CommandReason,
    CommandView,
    ContactView,
    ContactWish,
    Delegates,
    DelegateView,
    DeviceView,
    Enrolled,
    Enrolment,
    EnrolmentCodeView,
    Estimate,
    EstimateQuality,
    HandoverAsked,
    HandOverWish,
    Inbox,
    IntoHands,
    Link,
    LinkedCode,
    LinkedDelegate,
    LinkedDelegateView,
    LinkedHandOver,
    LongerWait,
    MapView,
    MyDelegates,
    MyView,
    NewDelegate,
    NewDevice,
    NewOrder,
    NewStandingOrder,
    NewTokenView,
    NewWebhook,
    NewWebhookView,
    NoticesRead,
    OrderPage,
    OrderView,
    PassingOn,
    PeoplePage,
    PersonView,
    PriorityChange,
    Reassignment,
    Resolution,
    RobotDetails,
    RobotPage,
    RobotTokenPage,
    Role,
    Sendings,
    SendingView,
    SessionPage,
    SignIn,
    SpooledMails,
    SpooledText,
    StandingOrderPage,
    StandingOrderView,
    TokenPage,
    TokenWish,
    Traffic,
    TrialView,
    WatchView,
    WayIsOpen,
    Wishes,
    WishesView,
)


class AsyncOperations:
    """What can be asked of the service; who answers is `_call`."""

    async def _call(
        self,
        method: str,
        path: str,
        kind: Any,
        *,
        body: Any = None,
        query: dict[str, Any] | None = None,
        headers: dict[str, Any] | None = None,
    ) -> Any:
        raise NotImplementedError

    async def estimate(self, *, from_post: str, to_post: str) -> Estimate:
        """When mail would arrive if it were ordered now."""
        answer: Estimate = await self._call(
            "GET", "/api/v1/estimate", Estimate, query={"from_post": from_post, "to_post": to_post}
        )
        return answer

    async def list_orders(
        self,
        *,
        role: Literal["sent", "coming", "all"] | str | None = None,
        state: Literal["open", "attention", "ended", "all"] | str | None = None,
        search: str | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> OrderPage:
        """This person's orders, newest first; a dispatcher's `all` is everybody's. `state` and `search` narrow it
        down.
        """
        answer: OrderPage = await self._call(
            "GET",
            "/api/v1/orders",
            OrderPage,
            query={"role": role, "state": state, "search": search, "limit": limit, "cursor": cursor},
        )
        return answer

    async def place_order(self, wish: NewOrder, *, idempotency_key: str) -> OrderView:
        """Place an order. The same key and body again give the first answer again, with `Idempotency-Replayed:
        true`.
        """
        answer: OrderView = await self._call(
            "POST", "/api/v1/orders", OrderView, body=wish, headers={"Idempotency-Key": idempotency_key}
        )
        return answer

    async def one_order(self, order_id: str) -> OrderView:
        """One order with its timeline."""
        answer: OrderView = await self._call("GET", f"/api/v1/orders/{quote(str(order_id), safe='')}", OrderView)
        return answer

    async def order_page_picture(self, order_id: str) -> bytes:
        """The address of the order's page as a QR code: from paper or from another screen to a phone."""
        answer: bytes = await self._call("GET", f"/api/v1/orders/{quote(str(order_id), safe='')}/page.svg", bytes)
        return answer

    async def cancel_order(self, order_id: str, *, if_match: str | None = None) -> OrderView:
        """Cancel, at once or (with a robot on its way) as soon as the robot answers."""
        answer: OrderView = await self._call(
            "POST", f"/api/v1/orders/{quote(str(order_id), safe='')}/cancel", OrderView, headers={"If-Match": if_match}
        )
        return answer

    async def about(self) -> About:
        """Name, version, time, languages; `demo` and `simulated` while a demonstration runs."""
        answer: About = await self._call("GET", "/api/v1/about", About)
        return answer

    async def campus_map(self) -> MapView:
        """Posts and corridors."""
        answer: MapView = await self._call("GET", "/api/v1/map", MapView)
        return answer

    async def mail_code(self, wish: CodeRequest) -> CodeMailed:
        """Mail an 8-digit code to an address of the campus; it is good in the browser that asks, known by a
        cookie.
        """
        answer: CodeMailed = await self._call("POST", "/api/v1/sign-in/codes", CodeMailed, body=wish)
        return answer

    async def sign_in(self, wish: SignIn) -> PersonView:
        """Exchange the mailed code for a session cookie, in the browser that asked for it."""
        answer: PersonView = await self._call("POST", "/api/v1/sign-in", PersonView, body=wish)
        return answer

    async def sign_out(self) -> None:
        """End this session."""
        await self._call("DELETE", "/api/v1/session", None)

    async def sign_in_at_the_campus(self) -> None:
        """Go to the campus's own sign-in."""
        await self._call("GET", "/api/v1/sign-in/oidc", None)

    async def come_back_from_the_campus(
        self, *, state: str | None = None, code: str | None = None, error: str | None = None
    ) -> None:
        """Come back from there, with a session or with `sign_in_problem`."""
        await self._call(
            "GET", "/api/v1/sign-in/oidc/callback", None, query={"state": state, "code": code, "error": error}
        )

    async def who_am_i(self) -> MyView:
        """The signed-in person; of a script: whose it is, with the roles that its scopes leave."""
        answer: MyView = await self._call("GET", "/api/v1/me", MyView)
        return answer

    async def change_me(self, wish: AboutMe) -> PersonView:
        """Change one's name, language or usual post."""
        answer: PersonView = await self._call("PATCH", "/api/v1/me", PersonView, body=wish)
        return answer

    async def my_contacts(
        self, *, search: str | None = None, limit: int | None = None, cursor: str | None = None
    ) -> AddressBook:
        """Those one exchanged mail with, newest first, and those one saved; `search` narrows it down."""
        answer: AddressBook = await self._call(
            "GET", "/api/v1/me/contacts", AddressBook, query={"search": search, "limit": limit, "cursor": cursor}
        )
        return answer

    async def keep_contact(self, email: str, wish: ContactWish) -> ContactView:
        """Save somebody with a label and a post, or change them."""
        answer: ContactView = await self._call(
            "PUT", f"/api/v1/me/contacts/{quote(str(email), safe='')}", ContactView, body=wish
        )
        return answer

    async def drop_contact(self, email: str) -> None:
        """Forget a saved contact."""
        await self._call("DELETE", f"/api/v1/me/contacts/{quote(str(email), safe='')}", None)

    async def my_sessions(self, *, limit: int | None = None, cursor: str | None = None) -> SessionPage:
        """Where this person is signed in, newest first."""
        answer: SessionPage = await self._call(
            "GET", "/api/v1/sessions", SessionPage, query={"limit": limit, "cursor": cursor}
        )
        return answer

    async def sign_out_elsewhere(self) -> None:
        """End all of this person's sessions but this one."""
        await self._call("DELETE", "/api/v1/sessions", None)

    async def end_one_session(self, session_id: int) -> None:
        """End one session, this one too."""
        await self._call("DELETE", f"/api/v1/sessions/{quote(str(session_id), safe='')}", None)

    async def my_tokens(self, *, limit: int | None = None, cursor: str | None = None) -> TokenPage:
        """The tokens of this person's scripts, newest first."""
        answer: TokenPage = await self._call(
            "GET", "/api/v1/tokens", TokenPage, query={"limit": limit, "cursor": cursor}
        )
        return answer

    async def make_token(self, wish: TokenWish) -> NewTokenView:
        """Make a token for a script: `Authorization: Bearer cmp_…`. It is shown now and never again."""
        answer: NewTokenView = await self._call("POST", "/api/v1/tokens", NewTokenView, body=wish)
        return answer

    async def revoke_one_token(self, prefix: str) -> None:
        """Revoke one token: it opens nothing from now on."""
        await self._call("DELETE", f"/api/v1/tokens/{quote(str(prefix), safe='')}", None)

    async def find_people(
        self, *, search: str | None = None, limit: int | None = None, cursor: str | None = None
    ) -> PeoplePage:
        """Everybody, by mail address; `search` narrows it down."""
        answer: PeoplePage = await self._call(
            "GET", "/api/v1/people", PeoplePage, query={"search": search, "limit": limit, "cursor": cursor}
        )
        return answer

    async def give_role(self, person_id: str, role: Role) -> PersonView:
        """Give somebody a role."""
        answer: PersonView = await self._call(
            "PUT", f"/api/v1/people/{quote(str(person_id), safe='')}/roles/{quote(str(role), safe='')}", PersonView
        )
        return answer

    async def take_role(self, person_id: str, role: Role) -> PersonView:
        """Take a role from somebody; everybody stays a member."""
        answer: PersonView = await self._call(
            "DELETE", f"/api/v1/people/{quote(str(person_id), safe='')}/roles/{quote(str(role), safe='')}", PersonView
        )
        return answer

    async def recall_order(self, order_id: str, *, if_match: str | None = None) -> OrderView:
        """Call mail back that is aboard. It turns round on the robot's word; until then the order goes on."""
        answer: OrderView = await self._call(
            "POST", f"/api/v1/orders/{quote(str(order_id), safe='')}/recall", OrderView, headers={"If-Match": if_match}
        )
        return answer

    async def say_not_now(self, order_id: str, *, if_match: str | None = None) -> OrderView:
        """Say as the recipient that it does not suit now. The mail goes back, on the robot's word."""
        answer: OrderView = await self._call(
            "POST", f"/api/v1/orders/{quote(str(order_id), safe='')}/not-now", OrderView, headers={"If-Match": if_match}
        )
        return answer

    async def extend_wait(self, order_id: str, wish: LongerWait, *, if_match: str | None = None) -> OrderView:
        """Let the robot wait longer. The person it waits for may ask a few times, a dispatcher for as much as is
        needed.
        """
        answer: OrderView = await self._call(
            "POST",
            f"/api/v1/orders/{quote(str(order_id), safe='')}/wait",
            OrderView,
            body=wish,
            headers={"If-Match": if_match},
        )
        return answer

    async def stop_order_for_attention(
        self, order_id: str, wish: Attention, *, if_match: str | None = None
    ) -> OrderView:
        """Take an order out of its robot's hands, as far as words go. What becomes of it is decided by `resolve`."""
        answer: OrderView = await self._call(
            "POST",
            f"/api/v1/orders/{quote(str(order_id), safe='')}/attention",
            OrderView,
            body=wish,
            headers={"If-Match": if_match},
        )
        return answer

    async def resolve_order(self, order_id: str, wish: Resolution, *, if_match: str | None = None) -> OrderView:
        """Decide what becomes of an order that needed attention."""
        answer: OrderView = await self._call(
            "POST",
            f"/api/v1/orders/{quote(str(order_id), safe='')}/resolve",
            OrderView,
            body=wish,
            headers={"If-Match": if_match},
        )
        return answer

    async def hold_order(self, order_id: str, wish: IntoHands, *, if_match: str | None = None) -> OrderView:
        """Say that the mail was taken out of the robot by hand and is held in the mailroom."""
        answer: OrderView = await self._call(
            "POST",
            f"/api/v1/orders/{quote(str(order_id), safe='')}/hold",
            OrderView,
            body=wish,
            headers={"If-Match": if_match},
        )
        return answer

    async def pass_order_on(self, order_id: str, wish: PassingOn, *, if_match: str | None = None) -> OrderView:
        """Say that the mail was taken out of its robot at a post, for another robot to carry it on from there."""
        answer: OrderView = await self._call(
            "POST",
            f"/api/v1/orders/{quote(str(order_id), safe='')}/pass-on",
            OrderView,
            body=wish,
            headers={"If-Match": if_match},
        )
        return answer

    async def reassign_order(self, order_id: str, wish: Reassignment, *, if_match: str | None = None) -> OrderView:
        """Let another robot fetch the mail. The one that is on its way lets go on its own word."""
        answer: OrderView = await self._call(
            "POST",
            f"/api/v1/orders/{quote(str(order_id), safe='')}/reassign",
            OrderView,
            body=wish,
            headers={"If-Match": if_match},
        )
        return answer

    async def prioritise_order(self, order_id: str, wish: PriorityChange, *, if_match: str | None = None) -> OrderView:
        """Fetch an order sooner than others, or later."""
        answer: OrderView = await self._call(
            "PUT",
            f"/api/v1/orders/{quote(str(order_id), safe='')}/priority",
            OrderView,
            body=wish,
            headers={"If-Match": if_match},
        )
        return answer

    async def list_standing_orders(self, *, limit: int | None = None, cursor: str | None = None) -> StandingOrderPage:
        """This person's standing orders, newest first; a dispatcher sees everybody's."""
        answer: StandingOrderPage = await self._call(
            "GET", "/api/v1/standing-orders", StandingOrderPage, query={"limit": limit, "cursor": cursor}
        )
        return answer

    async def place_standing_order(self, wish: NewStandingOrder) -> StandingOrderView:
        """Order something again and again. Each occurrence becomes an order of its own when its time comes."""
        answer: StandingOrderView = await self._call("POST", "/api/v1/standing-orders", StandingOrderView, body=wish)
        return answer

    async def one_standing_order(self, standing_order_id: str) -> StandingOrderView:
        """One standing order."""
        answer: StandingOrderView = await self._call(
            "GET", f"/api/v1/standing-orders/{quote(str(standing_order_id), safe='')}", StandingOrderView
        )
        return answer

    async def pause_standing_order(self, standing_order_id: str) -> StandingOrderView:
        """Make no orders of it until it is resumed."""
        answer: StandingOrderView = await self._call(
            "POST", f"/api/v1/standing-orders/{quote(str(standing_order_id), safe='')}/pause", StandingOrderView
        )
        return answer

    async def resume_standing_order(self, standing_order_id: str) -> StandingOrderView:
        """Make orders of it again from now on. What would have come round meanwhile is not made up for."""
        answer: StandingOrderView = await self._call(
            "POST", f"/api/v1/standing-orders/{quote(str(standing_order_id), safe='')}/resume", StandingOrderView
        )
        return answer

    async def end_standing_order(self, standing_order_id: str) -> StandingOrderView:
        """End it for good. The orders that it has made stay as they are."""
        answer: StandingOrderView = await self._call(
            "POST", f"/api/v1/standing-orders/{quote(str(standing_order_id), safe='')}/end", StandingOrderView
        )
        return answer

    async def linked_order(self, wish: Link) -> OrderView:
        """The order that this link was mailed for."""
        answer: OrderView = await self._call("POST", "/api/v1/link/order", OrderView, body=wish)
        return answer

    async def linked_code(self, wish: Link) -> LinkedCode:
        """The code of the recipient or the delegate, while it is their turn."""
        answer: LinkedCode = await self._call("POST", "/api/v1/link/code", LinkedCode, body=wish)
        return answer

    async def linked_hand_over(self, wish: LinkedHandOver) -> HandoverAsked:
        """Ask the robot that waits to hand over; 202: it is asked, and its receipt tells whether it has."""
        answer: HandoverAsked = await self._call("POST", "/api/v1/link/handover", HandoverAsked, body=wish)
        return answer

    async def linked_not_now(self, wish: Link) -> OrderView:
        """Say that nobody can take the mail now: the robot brings it back."""
        answer: OrderView = await self._call("POST", "/api/v1/link/not-now", OrderView, body=wish)
        return answer

    async def linked_delegate(self, wish: LinkedDelegate) -> LinkedDelegateView:
        """Name somebody who takes the mail instead, with a code of their own, which is shown here once."""
        answer: LinkedDelegateView = await self._call("POST", "/api/v1/link/delegate", LinkedDelegateView, body=wish)
        return answer

    async def my_notices(self, *, limit: int | None = None, cursor: str | None = None) -> Inbox:
        """What this person was told, newest first."""
        answer: Inbox = await self._call("GET", "/api/v1/notices", Inbox, query={"limit": limit, "cursor": cursor})
        return answer

    async def notices_read(self, wish: NoticesRead) -> None:
        """Mark notices as read."""
        await self._call("POST", "/api/v1/notices/read", None, body=wish)

    async def my_wishes(self) -> WishesView:
        """What this person is told, and where."""
        answer: WishesView = await self._call("GET", "/api/v1/me/notices", WishesView)
        return answer

    async def change_my_wishes(self, wish: Wishes) -> WishesView:
        """Mute kinds of notices on channels. The language is changed by `PATCH /me`."""
        answer: WishesView = await self._call("PUT", "/api/v1/me/notices", WishesView, body=wish)
        return answer

    async def add_device(self, wish: NewDevice) -> DeviceView:
        """Have notices shown by this browser (Web Push). The same endpoint again takes the place of the first."""
        answer: DeviceView = await self._call("POST", "/api/v1/me/devices", DeviceView, body=wish)
        return answer

    async def remove_device(self, device_id: str) -> None:
        """No more notices there."""
        await self._call("DELETE", f"/api/v1/me/devices/{quote(str(device_id), safe='')}", None)

    async def set_webhook(self, wish: NewWebhook) -> NewWebhookView:
        """Have each notice posted to an address, signed with the secret of the answer. Another address, another
        secret.
        """
        answer: NewWebhookView = await self._call("PUT", "/api/v1/me/webhook", NewWebhookView, body=wish)
        return answer

    async def remove_webhook(self) -> None:
        """Nothing is posted there any more."""
        await self._call("DELETE", "/api/v1/me/webhook", None)

    async def try_my_webhook(self) -> TrialView:
        """Post something to my webhook now, signed like a notice, and say what it answered."""
        answer: TrialView = await self._call("POST", "/api/v1/me/webhook/trial", TrialView)
        return answer

    async def not_sent(
        self, *, given_up: bool | None = None, limit: int | None = None, cursor: str | None = None
    ) -> Sendings:
        """Notices that have not gone out, or only those that were given up."""
        answer: Sendings = await self._call(
            "GET", "/api/v1/outbox", Sendings, query={"given_up": given_up, "limit": limit, "cursor": cursor}
        )
        return answer

    async def send_again(self, sending_id: int) -> SendingView:
        """Try once more, now: what was given up, or waits for its next try."""
        answer: SendingView = await self._call(
            "POST", f"/api/v1/outbox/{quote(str(sending_id), safe='')}/retry", SendingView
        )
        return answer

    async def spooled_mails(self) -> SpooledMails:
        """The newest mails that lie in the spool because no mail server is set."""
        answer: SpooledMails = await self._call("GET", "/api/v1/spool", SpooledMails)
        return answer

    async def spooled_mail(self, file: str) -> SpooledText:
        """One mail of the spool. Codes and links that open something are taken out; pictures are named, not shown."""
        answer: SpooledText = await self._call("GET", f"/api/v1/spool/{quote(str(file), safe='')}", SpooledText)
        return answer

    async def all_robots(self, *, limit: int | None = None, cursor: str | None = None) -> RobotPage:
        """Where the robots were last seen and what they are doing."""
        answer: RobotPage = await self._call(
            "GET", "/api/v1/robots", RobotPage, query={"limit": limit, "cursor": cursor}
        )
        return answer

    async def traffic(self) -> Traffic:
        """Which robot holds which corridor: all of them, or those with an order of one's own for members."""
        answer: Traffic = await self._call("GET", "/api/v1/map/traffic", Traffic)
        return answer

    async def one_robot(self, name: str) -> RobotDetails:
        """One robot: where it is, battery, faults, software, when it was last heard, how far its clock is off."""
        answer: RobotDetails = await self._call("GET", f"/api/v1/robots/{quote(str(name), safe='')}", RobotDetails)
        return answer

    async def list_robot_commands(
        self, name: str, *, limit: int | None = None, cursor: str | None = None
    ) -> CommandPage:
        """List what a robot was told to do, and what it answered, newest first."""
        answer: CommandPage = await self._call(
            "GET",
            f"/api/v1/robots/{quote(str(name), safe='')}/commands",
            CommandPage,
            query={"limit": limit, "cursor": cursor},
        )
        return answer

    async def pause_robot(self, name: str, wish: CommandReason) -> CommandView:
        """Let a robot wait at the next post until it is told to resume."""
        answer: CommandView = await self._call(
            "POST", f"/api/v1/robots/{quote(str(name), safe='')}/pause", CommandView, body=wish
        )
        return answer

    async def resume_robot(self, name: str) -> CommandView:
        """Let a robot go on after a pause or an emergency stop: whoever says so has looked."""
        answer: CommandView = await self._call(
            "POST", f"/api/v1/robots/{quote(str(name), safe='')}/resume", CommandView
        )
        return answer

    async def recall_robot(self, name: str, wish: CommandReason) -> CommandView:
        """Let a robot bring back what is aboard and go home."""
        answer: CommandView = await self._call(
            "POST", f"/api/v1/robots/{quote(str(name), safe='')}/recall", CommandView, body=wish
        )
        return answer

    async def stop_robot(self, name: str, wish: CommandReason) -> CommandView:
        """Let a robot stand still at once, until it is told to resume. A best effort: without network it has not
        heard.
        """
        answer: CommandView = await self._call(
            "POST", f"/api/v1/robots/{quote(str(name), safe='')}/emergency-stop", CommandView, body=wish
        )
        return answer

    async def tell_robot_of_open_way(self, name: str, wish: WayIsOpen) -> CommandView:
        """Tell a robot that a corridor which it took for closed is free again: whoever says so has looked."""
        answer: CommandView = await self._call(
            "POST", f"/api/v1/robots/{quote(str(name), safe='')}/open-way", CommandView, body=wish
        )
        return answer

    async def take_robot_out(self, name: str, wish: CommandReason) -> CommandView:
        """Give the corridors of a robot that is dead to others: whoever says so has looked, and it is in nobody's
        way.

        It stands still when it hears so, until it is put down at a post or in a dock.
        """
        answer: CommandView = await self._call(
            "POST", f"/api/v1/robots/{quote(str(name), safe='')}/take-out", CommandView, body=wish
        )
        return answer

    async def list_alarms(
        self,
        *,
        only_open: bool | None = None,
        robot: str | None = None,
        limit: int | None = None,
        cursor: str | None = None,
    ) -> AlarmPage:
        """List what people should look at, newest first."""
        answer: AlarmPage = await self._call(
            "GET",
            "/api/v1/alarms",
            AlarmPage,
            query={"only_open": only_open, "robot": robot, "limit": limit, "cursor": cursor},
        )
        return answer

    async def acknowledge_alarm(self, alarm_id: int) -> AlarmView:
        """Say that somebody sees to an alarm. It stays open until it is over by itself."""
        answer: AlarmView = await self._call(
            "POST", f"/api/v1/alarms/{quote(str(alarm_id), safe='')}/acknowledge", AlarmView
        )
        return answer

    async def close_corridor(self, corridor: str, wish: CommandReason) -> ClosedCorridors:
        """Let no robot into a corridor any more, until it is opened again; whoever is in there drives on."""
        answer: ClosedCorridors = await self._call(
            "POST", f"/api/v1/corridors/{quote(str(corridor), safe='')}/close", ClosedCorridors, body=wish
        )
        return answer

    async def open_corridor(self, corridor: str) -> ClosedCorridors:
        """Let robots into a closed corridor again: whoever says so has looked. Robots that turned back there are
        told.
        """
        answer: ClosedCorridors = await self._call(
            "POST", f"/api/v1/corridors/{quote(str(corridor), safe='')}/open", ClosedCorridors
        )
        return answer

    async def closed_corridors(self) -> ClosedCorridors:
        """List the corridors into which no robot is let: people have closed them, or robots turned back there."""
        answer: ClosedCorridors = await self._call("GET", "/api/v1/corridors/closed", ClosedCorridors)
        return answer

    async def robot_battery(self, name: str, *, since: datetime | None = None) -> BatteryHistory:
        """Show a robot's charge over time, as it told it."""
        answer: BatteryHistory = await self._call(
            "GET", f"/api/v1/robots/{quote(str(name), safe='')}/battery", BatteryHistory, query={"since": since}
        )
        return answer

    async def watch_robot(self, name: str, *, anew: bool | None = None) -> WatchView:
        """Watch what a robot senses and thinks: events `insight` of the live stream, for half a minute from now.

        Say so again every ten seconds or so. Nothing of it is kept.
        """
        answer: WatchView = await self._call(
            "POST", f"/api/v1/robots/{quote(str(name), safe='')}/watch", WatchView, query={"anew": anew}
        )
        return answer

    async def estimate_quality(self) -> EstimateQuality:
        """Show how good estimated arrivals were, and how long corridors and stops take."""
        answer: EstimateQuality = await self._call("GET", "/api/v1/estimates", EstimateQuality)
        return answer

    async def make_enrolment_code(self, name: str) -> EnrolmentCodeView:
        """Make a one-time code by which a robot of this name enrols itself, for the first time or again."""
        answer: EnrolmentCodeView = await self._call(
            "POST", f"/api/v1/robots/{quote(str(name), safe='')}/enrolment-codes", EnrolmentCodeView
        )
        return answer

    async def enrol_robot(self, wish: Enrolment) -> Enrolled:
        """Exchange a one-time code for a robot's token; its receipts are checked by the key that it brings."""
        answer: Enrolled = await self._call("POST", "/api/v1/robots/enrol", Enrolled, body=wish)
        return answer

    async def list_robot_tokens(
        self, name: str, *, limit: int | None = None, cursor: str | None = None
    ) -> RobotTokenPage:
        """List the tokens that a robot has had, newest first: prefix, when made, used and taken back."""
        answer: RobotTokenPage = await self._call(
            "GET",
            f"/api/v1/robots/{quote(str(name), safe='')}/tokens",
            RobotTokenPage,
            query={"limit": limit, "cursor": cursor},
        )
        return answer

    async def revoke_robot_token(self, name: str, token_prefix: str) -> None:
        """Take a robot's token back: whoever is connected by it is cut off, and nobody signs in by it again."""
        await self._call(
            "DELETE", f"/api/v1/robots/{quote(str(name), safe='')}/tokens/{quote(str(token_prefix), safe='')}", None
        )

    async def my_code(self, order_id: str) -> CodeView:
        """The hand-over code of whoever's turn it is, as a QR text and six digits."""
        answer: CodeView = await self._call("GET", f"/api/v1/orders/{quote(str(order_id), safe='')}/code", CodeView)
        return answer

    async def my_code_picture(self, order_id: str) -> bytes:
        """The same code as a picture."""
        answer: bytes = await self._call("GET", f"/api/v1/orders/{quote(str(order_id), safe='')}/code.svg", bytes)
        return answer

    async def hand_over(self, order_id: str, wish: HandOverWish) -> HandoverAsked:
        """Ask the robot that waits to hand over: by a tap of whoever's turn it is, or by the digits of a code.

        202: the robot is asked. Mail has changed hands when its receipt has come; the order moves then, and its
        `handover_requested` is null again.
        """
        answer: HandoverAsked = await self._call(
            "POST", f"/api/v1/orders/{quote(str(order_id), safe='')}/handover", HandoverAsked, body=wish
        )
        return answer

    async def list_delegates(self, order_id: str, *, limit: int | None = None, cursor: str | None = None) -> Delegates:
        """List who may hand over for the caller, those whose code was taken back too, oldest first."""
        answer: Delegates = await self._call(
            "GET",
            f"/api/v1/orders/{quote(str(order_id), safe='')}/delegates",
            Delegates,
            query={"limit": limit, "cursor": cursor},
        )
        return answer

    async def name_delegate(self, order_id: str, wish: NewDelegate) -> DelegateView:
        """Name somebody who hands over instead, with a code of their own."""
        answer: DelegateView = await self._call(
            "POST", f"/api/v1/orders/{quote(str(order_id), safe='')}/delegates", DelegateView, body=wish
        )
        return answer

    async def my_delegates(self, *, limit: int | None = None, cursor: str | None = None) -> MyDelegates:
        """List whom the caller has named to hand over, for all orders that go on; each is taken back at its order."""
        answer: MyDelegates = await self._call(
            "GET", "/api/v1/me/delegates", MyDelegates, query={"limit": limit, "cursor": cursor}
        )
        return answer

    async def revoke_delegate(self, order_id: str, delegate_id: str) -> None:
        """Take a delegate's code back. A robot without network hears of it when it is back."""
        await self._call(
            "DELETE",
            f"/api/v1/orders/{quote(str(order_id), safe='')}/delegates/{quote(str(delegate_id), safe='')}",
            None,
        )

    async def delegate_code(self, order_id: str, delegate_id: str) -> CodeView:
        """A delegate's code, to be passed on to them."""
        answer: CodeView = await self._call(
            "GET",
            f"/api/v1/orders/{quote(str(order_id), safe='')}/delegates/{quote(str(delegate_id), safe='')}/code",
            CodeView,
        )
        return answer

    async def delegate_code_picture(self, order_id: str, delegate_id: str) -> bytes:
        """The same code as a picture."""
        answer: bytes = await self._call(
            "GET",
            f"/api/v1/orders/{quote(str(order_id), safe='')}/delegates/{quote(str(delegate_id), safe='')}/code.svg",
            bytes,
        )
        return answer

    async def release_digits(self, order_id: str) -> OrderView:
        """Let the digits of an order be typed again after five wrong ones."""
        answer: OrderView = await self._call(
            "POST", f"/api/v1/orders/{quote(str(order_id), safe='')}/digits/release", OrderView
        )
        return answer

    async def export_orders(self, *, from_: datetime | None = None, to: datetime | None = None) -> bytes:
        """Everybody's orders of a time as a table (CSV, RFC 4180, UTF-8 with a byte order mark), the oldest first.

        The columns keep their names and order; new ones come behind them. What would be run as a formula by a
        spreadsheet begins with an apostrophe.
        """
        answer: bytes = await self._call("GET", "/api/v1/orders.csv", bytes, query={"from": from_, "to": to})
        return answer

    async def marker_picture(self, post: str) -> bytes:
        """A post's marker sheet (SVG, 148 × 210 mm, to be printed at 100 %), as often as it says."""
        answer: bytes = await self._call("GET", f"/api/v1/map/posts/{quote(str(post), safe='')}/marker.svg", bytes)
        return answer
