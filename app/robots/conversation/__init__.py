"""One robot's socket: handshake, intake, acknowledgements.

May use all of `app.robots` but the routes.
Start at `conversation.py`.
"""
