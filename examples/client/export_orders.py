"""Write all of one's orders as CSV: python export_orders.py > orders.csv

CAMPUS_MAIL_URL says where the service is, CAMPUS_MAIL_TOKEN lets this program in (scope orders:read). A dispatcher's
token, with the scope dispatch besides, gives everybody's.
"""

import csv
import os
import sys

from campus_mail_client import CampusMail

COLUMNS = ("id", "state", "created_at", "updated_at", "from_post", "to_post", "sender", "recipient", "robot")


def main() -> None:
    table = csv.writer(sys.stdout)
    table.writerow(COLUMNS)
    with CampusMail(os.environ["CAMPUS_MAIL_URL"], os.environ["CAMPUS_MAIL_TOKEN"]) as mail:
        for order in mail.each(mail.list_orders, limit=100):
            robot = next((event.robot for event in reversed(order.events) if event.robot), "")
            times = (order.created_at.isoformat(), order.updated_at.isoformat())
            people = (order.sender.email, order.recipient.email)
            table.writerow((order.id, order.state, *times, order.from_post, order.to_post, *people, robot))


if __name__ == "__main__":
    main()
