"""Examples of what people and programs write and read, by the name of its schema; a test holds them to it."""

from collections.abc import Mapping
from typing import Any, Final

ADA, BEN, EVE = (f"{name}@campus.example" for name in ("ada.king", "ben.ode", "eve.ito"))
LETTER: Final = {"from_post": "post1", "to_post": "post4", "recipient": BEN, "description": "A letter"}
TOKEN_OF_A_LINK: Final = "0" * 43

ROBOT: Final = {
    "name": "r1",
    "online": True,
    "last_seen": {"post": "post2", "previous": "post1", "at": "2026-01-05T09:03:12Z"},
    "towards": "post3",
    "expected": {"post": "post3", "from": "2026-01-05T09:03:25Z", "to": "2026-01-05T09:03:52Z"},
    "activity": "driving",
    "battery": {"ratio": 0.81, "charging": False, "charges_to": None},
    "why": "I am carrying mail to post4.",
    "why_words": None,
    "waits_for": None,
    "taken_out_at": None,
    "heard_at": "2026-01-05T09:03:14Z",
}
PROBLEM: Final = {
    "type": "urn:campus-mail:problem:unknown_post",
    "title": "Unprocessable Entity",
    "status": 422,
    "detail": "There is no post 'pots4' on the map. Did you mean 'post4'?",
    "code": "unknown_post",
}

EXAMPLES: Final[Mapping[str, tuple[Mapping[str, Any], ...]]] = {
    # signing in, and who one is
    "CodeRequest": ({"email": ADA},),
    "SignIn": ({"email": ADA, "code": "20260105"},),
    "AboutMe": ({"name": "Ada King", "language": "fr", "usual_post": "post1"}, {"usual_post": None}),
    "ContactRequest": ({"label": "Ben, registry", "post": "post4"},),
    "TokenRequest": ({"name": "nightly export", "scopes": ["orders:read"], "days": 90},),
    # orders
    "NewOrder": (LETTER, {**LETTER, "not_before": "2026-01-06T08:00:00Z", "priority": "low"}),
    "NewStandingOrder": ({**LETTER, "weekdays": [0, 2, 4], "at": "09:30", "zone": "America/Toronto"},),
    "LongerWait": ({"extend_s": 300},),
    "NewDelegate": ({"name": "Eve Ito", "email": EVE, "purpose": "receive"},),
    "HandoverRequest": ({"digits": ""}, {"digits": "123456"}),
    # by the link in a mail
    "Link": ({"token": TOKEN_OF_A_LINK},),
    "LinkedDelegate": ({"name": "Eve Ito", "email": EVE, "token": TOKEN_OF_A_LINK},),
    "LinkedHandOver": ({"digits": "123456", "token": TOKEN_OF_A_LINK},),
    # dispatchers
    "PriorityChange": ({"priority": "high"},),
    "Reassignment": ({"robot": "r2"}, {"robot": None}),
    "Attention": ({"reason": "The lid of r1 does not close."},),
    "Resolution": ({"to": "returning", "reason": "The corridor stays closed today."},),
    "PassingOn": ({"post": "post3", "reason": "Its battery is flat."}, {"post": None}),
    "IntoHands": ({"reason": "Fetched by hand at post2."},),
    "CommandReason": ({"reason": "The corridor is being cleaned."},),
    "WayIsOpen": ({"corridor": "post2-post3"},),
    "Enrolment": ({"name": "r1", "code": "7KQ2-M4XD", "public_key": "A" * 43 + "="},),
    "ShowCode": ({"order_id": "1f2e3d4c5b6a7988"},),
    # notices; the keys of the browser are those of RFC 8291
    "NoticesRead": ({"ids": [17, 18]},),
    "PreferencesRequest": ({"muted": {"mail": ["robot_near"], "push": []}},),
    "NewWebhook": ({"url": "https://hooks.campus.example/mail"},),
    "NewDevice": (
        {
            "endpoint": "https://push.example.net/push/JzLQ3raZJfFBR0aqvOMsLrt54w4rJUsV",
            "keys": {
                "p256dh": "BCVxsr7N_eNgVRqvHtD0zTZsEc6-VV-JvLexhqUzORcxaOzi6-AYWXvTBHm4bjyPjs7Vd8pZGH6SRpkNtoIAiw4",
                "auth": "BTBZMqHH6r4Tts7J_aSIgg",
            },
        },
    ),
    # answers
    "RobotView": (ROBOT,),
    "Problem": (PROBLEM,),
}
