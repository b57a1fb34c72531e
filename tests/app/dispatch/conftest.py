"""The fixtures of tests/app/robots: a real service, and a robot that the test plays."""

from tests.app.robots.conftest import robot, service  # noqa: F401  # fixtures
