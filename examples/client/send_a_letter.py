"""Send a letter and follow it to its end: python send_a_letter.py post1 post4 ben.ode@campus.example

CAMPUS_MAIL_URL says where the service is, CAMPUS_MAIL_TOKEN lets this program in (scopes orders:read, orders:write and
live:read; made at "my tokens" or by POST /api/v1/tokens).
"""

import os
import sys

from campus_mail_client import CampusMail, CampusMailError


def main(from_post: str, to_post: str, recipient: str) -> None:
    with CampusMail(os.environ["CAMPUS_MAIL_URL"], os.environ["CAMPUS_MAIL_TOKEN"]) as mail:
        placed = mail.place(from_post, to_post, recipient, "A letter")
        expected = f"expected by {placed.window.to:%H:%M} UTC" if placed.window else "no time of arrival is known yet"
        print(f"{placed.id}: {expected}")
        state = ""
        for order in mail.follow(placed.id):
            if order.state != state:
                state = order.state
                print(f"{order.updated_at:%H:%M:%S}  {state}")


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except CampusMailError as error:
        sys.exit(f"It was not sent: {error}")
