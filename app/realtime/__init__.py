"""The live feed inside the service, and one event stream per browser.

Features publish to `feed.py` after a commit.
Start at `feed.py`.
"""
