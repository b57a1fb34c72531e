"""Examples of the bodies that people write and read most, by the name of their schema; a test holds them to it."""

from collections.abc import Mapping
from typing import Any, Final

ROBOT: Final = {
    "name": "r1",
    "online": True,
    "last_seen": {"post": "post2", "previous": "post1", "at": "2026-01-05T09:03:12Z"},
    "towards": "post3",
    "expected": {"post": "post3", "from": "2026-01-05T09:03:25Z", "to": "2026-01-05T09:03:52Z"},
    "activity": "driving",
    "battery": {"ratio": 0.81, "charging": False},
    "why": "Driving towards post3",
    "why_words": {"key": "why.driving", "facts": {"post": "post3"}},
    "heard_at": "2026-01-05T09:03:14Z",
}

EXAMPLES: Final[Mapping[str, tuple[Mapping[str, Any], ...]]] = {
    "CodeRequest": ({"email": "ada.king@campus.example"},),
    "SignIn": ({"email": "ada.king@campus.example", "code": "20260105"},),
    "NewOrder": (
        {"from_post": "post1", "to_post": "post4", "recipient": "ben.ode@campus.example", "description": "A letter"},
    ),
    "NoticesRead": ({"ids": [17, 18]},),
    "RobotView": (ROBOT,),
    "Problem": (
        {
            "type": "urn:campus-mail:problem:unknown_post",
            "title": "Unprocessable Entity",
            "status": 422,
            "detail": "There is no post 'pots4' on the map. Did you mean 'post4'?",
            "code": "unknown_post",
        },
    ),
}
