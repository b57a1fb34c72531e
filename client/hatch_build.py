"""Build hook of the client: refuses to build it without the modules that `make client` writes."""

from pathlib import Path
from typing import Any, Final

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

MADE: Final = ("async_operations", "client", "models", "operations", "problems")


class CustomBuildHook(BuildHookInterface[Any]):
    """Adds nothing; a client without its models installs without complaint, and fails at the first import."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Raise FileNotFoundError that names what is missing and how to get it."""
        package = Path(self.root) / "campus_mail_client"
        if missing := [name for name in MADE if not (package / f"{name}.py").is_file()]:
            raise FileNotFoundError(f"{', '.join(missing)}: not written yet. Run `make client` in the checkout first.")
