"""Print what the robots do, as they do it: python watch_robots.py [how many changes]

CAMPUS_MAIL_URL says where the service is, CAMPUS_MAIL_TOKEN lets this program in (scopes robots:read and live:read).
"""

import asyncio
import os
import sys

from campus_mail_client import AsyncCampusMail
from campus_mail_client.models import RobotView


async def main(changes_wanted: int) -> None:
    async with AsyncCampusMail(os.environ["CAMPUS_MAIL_URL"], os.environ["CAMPUS_MAIL_TOKEN"]) as mail:
        async for change in mail.changes():
            if change.event in {"connected", "resync"}:
                async for robot in mail.each(mail.all_robots):
                    print(line(robot))
            elif change.event == "robot":
                print(line(RobotView.model_validate(change.data)), flush=True)
                changes_wanted -= 1
            if changes_wanted == 0:
                return


def line(robot: RobotView) -> str:
    seen = f"seen at {robot.last_seen.post}" if robot.last_seen else "not seen yet"
    return f"{robot.name:10} {'online' if robot.online else 'offline':8} {robot.activity:10} {seen}"


if __name__ == "__main__":
    asyncio.run(main(int(sys.argv[1]) if sys.argv[1:] else -1))
