"""Every picture: whose screen, which page, what has to stand there, and what they did before."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Final

from tests.web.pictures import doings
from tests.web.pictures.doings import Doing


class Scene(StrEnum):
    """The scene of a picture, in this order."""

    DAY = "day"
    TROUBLE = "trouble"
    MIND = "mind"


@dataclass(frozen=True)
class Picture:
    """`{driving}` in `address` is the id of that order of the day; `shows` is a selector."""

    name: str
    who: str
    address: str
    shows: str
    doing: Doing | None = None
    scene: Scene = Scene.DAY


ADA, NEWCOMER, ANONYMOUS, DANA, MIRA = "ada.lovelace", "new.comer", "anonymous", "dana.desk", "mira.klein"
ROWS: Final = "main li"

PICTURES: Final = (
    Picture("sign-in", ANONYMOUS, "/", "input[type=email]"),
    Picture("first-help", NEWCOMER, "/", ".first-steps li"),
    Picture("order", ADA, "/", "[name=from_post]", doings.fill_in_the_order),
    Picture("order-placed", ADA, "/follow.html?order={placed}", ".standing h1"),
    Picture("follow", ADA, "/follow.html?order={driving}", ".standing h1"),
    Picture("hand-over", ADA, "/follow.html?order={handover}", ".qr"),
    Picture("delivered", ADA, "/follow.html?order={week_1}", ".standing h1"),
    Picture("one-order", ANONYMOUS, "{guest_link}", ".qr"),
    Picture("mail", ADA, "/mail.html", ROWS),
    Picture("mail-empty", NEWCOMER, "/mail.html", ".empty"),
    Picture("notices", ADA, "/notices.html", ROWS),
    Picture("notices-empty", NEWCOMER, "/notices.html", ".empty"),
    Picture("settings", ADA, "/settings.html", ".preferences"),
    Picture("no-role", ADA, "/mailroom.html", "main h1"),
    Picture("mailroom", DANA, "/mailroom.html", ".queue li"),
    Picture("walk-up", DANA, "/mailroom.html", ".queue li", doings.open_the_desk),
    Picture("print-markers", DANA, "/print.html", ".marker-sheet"),
    Picture("print-slip", DANA, "/print.html?order={driving}", "article"),
    Picture("robots", MIRA, "/robots.html", ROWS),
    Picture("robot", MIRA, "/robots.html?robot=r1", ".curve .charge"),
    Picture("order-offline", ADA, "/", "[name=from_post]", doings.order_without_network),
    Picture("mailroom-trouble", DANA, "/mailroom.html", ".issues li:nth-child(5)", scene=Scene.TROUBLE),
    Picture("wall", DANA, "/mailroom.html?wall", ".issues li:nth-child(5)", scene=Scene.TROUBLE),
    Picture("robot-faults", MIRA, "/robots.html?robot=r1", "robot-faults li", doings.come_to_the_faults, Scene.TROUBLE),
    Picture("robot-mind", MIRA, "/robots.html?robot=r5", "robot-diagnostics", doings.come_to_the_mind, Scene.MIND),
)
