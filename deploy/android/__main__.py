"""`make android` builds a signed package for Android phones that shows the pages of one host full screen.

It is a Trusted Web Activity, built with Debian's tools alone. Launcher.smali opens the pages; it is assembler for
Android's byte code, since Debian has neither the Java classes of Android nor a compiler to its byte code.
"""

import argparse
import json
import os
import re
import secrets
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import Final

from app.core.setting_kinds import android_package
from app.http.asset_links import statements
from protocol.software import version

HERE: Final = Path(__file__).parent
CHECKOUT: Final = HERE.parents[1]
PAGES: Final = CHECKOUT / "web/public"
FRAMEWORK: Final = Path("/usr/share/android-framework-res/framework-res.apk")
DEBIAN_PACKAGES: Final[Mapping[str, str]] = {
    "aapt": "aapt",
    "apksigner": "apksigner",
    "keytool": "default-jre-headless",
    "smali": "libsmali-java",
    "zipalign": "zipalign",
    str(FRAMEWORK): "android-framework-res",
}
"""What the build calls or reads, and the package of Debian that brings it."""
ALIAS: Final = "campus-mail"
KIND_OF_KEY: Final = "-keyalg EC -groupname secp256r1 -validity 36500"
HOST: Final = re.compile(r"(?=.{4,253}$)([a-z0-9]([a-z0-9-]{0,61}[a-z0-9])?\.)+[a-z]([a-z0-9-]{0,61}[a-z0-9])?")


class BuildError(Exception):
    """The package cannot be built: a value, a tool or the key is not as it must be."""


def main() -> None:
    """Build the package and print what the service has to know of it."""
    parser = argparse.ArgumentParser(description="Build a signed Android package that opens the pages of one host.")
    parser.add_argument("host", help="name of the host that serves the pages, such as mail.campus.example")
    parser.add_argument("package", help="name of the app, such as example.campus.mail")
    parser.add_argument("--folder", type=Path, default=CHECKOUT / "var/android", help="of key, password and package")
    asked = parser.parse_args()
    try:
        host, package = checked(asked.host, asked.package)
        require_tools()
        key = key_in(asked.folder)
        built = asked.folder / f"{package}.apk"
        build(host, package, key, built)
        print(report(host, package, key, built))
    except BuildError as error:
        sys.exit(f"No Android package was built: {error}")


def checked(host: str, package: str) -> tuple[str, str]:
    """Return host and package, or raise BuildError that names the one which is wrong."""
    if not HOST.fullmatch(host):
        raise BuildError(
            f"HOST={host!r} is no host name; one looks like mail.campus.example (no https://, port or path)"
        )
    try:
        if android_package(package):
            return host, package
    except ValueError as error:
        raise BuildError(f"PACKAGE={error}") from None
    raise BuildError("PACKAGE is missing; one looks like example.campus.mail")


def require_tools() -> None:
    """Raise BuildError with the names of Debian's packages if a tool is missing."""
    missing = [what for what in DEBIAN_PACKAGES if not (shutil.which(what) or Path(what).is_file())]
    if missing:
        packages = " ".join(DEBIAN_PACKAGES[what] for what in missing)
        raise BuildError(f"{', '.join(missing)} missing; on Debian: apt install {packages}")


@dataclass(frozen=True)
class Key:
    """A signing key and its password, each in a file that only its owner may read."""

    store: Path
    password: Path


def key_in(folder: Path) -> Key:
    """Return the folder's key, made the first time. Phones take an update only with the same key."""
    key = Key(folder / "key.p12", folder / "password")
    if key.store.exists() and key.password.exists():
        return key
    if key.store.exists() or key.password.exists():
        there, gone = (key.store, key.password) if key.store.exists() else (key.password, key.store)
        raise BuildError(f"{there} is there, but not {gone}: put it back, or move it away for a new key and a new app")
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    # Made aside and put in place whole: a password without its key would stop every later build.
    with tempfile.TemporaryDirectory(dir=folder) as aside:
        new = Key(Path(aside) / "key.p12", Path(aside) / "password")
        new.password.touch(mode=0o600)
        new.password.write_text(secrets.token_urlsafe(32))
        store = ("-keystore", new.store, "-storepass:file", new.password, "-alias", ALIAS)
        run(f"keytool -genkeypair -storetype PKCS12 {KIND_OF_KEY} -dname CN={ALIAS}", *store)
        new.store.chmod(0o600)
        new.password.rename(key.password)
        new.store.rename(key.store)
    return key


def build(host: str, package: str, key: Key, built: Path) -> None:
    """Write the signed package."""
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        fill_in(work, values_for(host, package))
        run("smali assemble --api 26 --output", work / "classes.dex", *sorted(work.glob("*.smali")))
        # Android 11 and later read the table of resources as it lies in the file: not compressed, and aligned.
        sources = ("-M", work / "AndroidManifest.xml", "-S", work / "res", "-I", FRAMEWORK)
        run("aapt package -0 arsc", *sources, "-F", work / "plain.apk")
        with zipfile.ZipFile(work / "plain.apk", "a", zipfile.ZIP_DEFLATED) as archive:
            archive.write(work / "classes.dex", "classes.dex")
        run("zipalign 4", work / "plain.apk", work / "aligned.apk")
        signer = ("--ks", key.store, "--ks-key-alias", ALIAS, "--ks-pass", f"file:{key.password}")
        run("apksigner sign --v1-signing-enabled false", *signer, "--out", work / "signed.apk", work / "aligned.apk")
        shutil.move(work / "signed.apk", built)


def values_for(host: str, package: str) -> dict[str, str]:
    """Return what the templates leave open."""
    manifest = json.loads((PAGES / "manifest.webmanifest").read_text(encoding="utf-8"))
    major, minor, patch = (int(number) for number in re.findall(r"\d+", version())[:3])
    return {
        "host": host,
        "package": package,
        "version": version(),
        "version_code": str((major * 1000 + minor) * 1000 + patch),
        "name": manifest["short_name"],
        "colour": manifest["theme_color"],
    }


def fill_in(work: Path, values: Mapping[str, str]) -> None:
    """Copy the templates, with their values, and the app's icon."""
    for template in (path for pattern in ("*.smali", "**/*.xml") for path in HERE.glob(pattern)):
        target = work / template.relative_to(HERE)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(Template(template.read_text(encoding="utf-8")).substitute(values), encoding="utf-8")
    pictures = work / "res/drawable-nodpi"
    pictures.mkdir()
    shutil.copy(PAGES / "icons/icon-maskable-512.png", pictures / "picture.png")


def fingerprint(built: Path) -> str:
    """Return the SHA-256 fingerprint of the certificate that a package is signed with; its signature is verified."""
    said = run("apksigner verify --print-certs", built)
    found = re.search(r"certificate SHA-256 digest: ([0-9a-f]{64})", said)
    if not found:
        raise BuildError(f"apksigner names no certificate: {said}")
    return ":".join(re.findall("..", found[1].upper()))


def report(host: str, package: str, key: Key, built: Path) -> str:
    """Return what the user does next, with the settings of the service."""
    signed_with = fingerprint(built)
    return f"""{built}: version {version()}, {built.stat().st_size / 1000:.0f} kB. It has not been tried on a phone.
Keep {key.store} and {key.password.name} beside it: without them the app cannot be updated.

Settings of the service at {host}, without which the app shows an address bar:
CAMPUS_MAIL_ANDROID_PACKAGE={package}
CAMPUS_MAIL_ANDROID_FINGERPRINTS='["{signed_with}"]'

It then answers https://{host}/.well-known/assetlinks.json:
{json.dumps(statements(package, [signed_with]), indent=2)}"""


def run(command: str, *arguments: object) -> str:
    """Run a tool, with arguments beside the words of the command; return its output, or raise BuildError with it."""
    words = [*command.split(), *(str(argument) for argument in arguments)]
    finished = subprocess.run(words, capture_output=True, text=True, env=os.environ | {"LC_ALL": "C"}, check=False)
    if finished.returncode:
        raise BuildError(f"{words[0]} failed:\n{finished.stdout}{finished.stderr}".rstrip())
    return finished.stdout


if __name__ == "__main__":
    main()
