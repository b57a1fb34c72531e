"""Enrolment: a maintainer's one-time code makes a robot known.

May use `app.robots.service`.
Start at `service.py`.
"""
