"""The link to the service: connection, retries, enrolment.

May use the mission's memory and outbox.
Start at `link.py`.
"""
