"""What a robot tells of its senses and its mind while somebody at the service watches."""

from robot.insight.desk import Insights

__all__ = ["Insights"]
