"""What a robot tells of its senses and its mind while somebody at the service watches."""

from .desk import Insights

__all__ = ["Insights"]
