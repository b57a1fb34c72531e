"""The composition of the service: its parts, what wakes what, its routes and its background work.

The only place that knows every feature; nothing below imports it but `app.cli`.
Start at `parts.py`, which builds the parts in reading order, then at `application.py`.
"""

from app.composition.application import API, create_app
from app.composition.parts import Parts

__all__ = ["API", "Parts", "create_app"]
