"""The real service on a real port, and a robot that the test plays."""

from tests.app.robots.conftest import robot, service

__all__ = ["robot", "service"]
