"""Sessions of browsers: cookies, their origin, and the device that they were opened with.

Sign-in opens them; `current_user` reads them.
Start at `sessions.py`.
"""
