"""Stage the pages, add the generated reference, and build the site into var/site. A warning is an error."""

import shutil
import subprocess
import sys

from docs.site import staging
from docs.site.reference import pages


def main() -> int:
    staging.stage(staging.SOURCE)
    for name, text in pages().items():
        (staging.SOURCE / "reference" / name).write_text(text, encoding="utf-8")
    shutil.rmtree(staging.SITE, ignore_errors=True)
    command = [sys.executable, "-m", "zensical", "build", "--strict", "--clean", *sys.argv[1:]]
    return subprocess.run(command, cwd=staging.CHECKOUT, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
