"""`make android` builds a signed package that opens the pages of one host. There is no phone here to install it on.

Android's own tools say what the package holds, and a JVM verifies and runs the launcher among stand-ins for the few
classes of Android that it touches (android_stand_in.java).
"""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from app.http.asset_links import statements
from deploy.android.__main__ import BuildError, checked, key_in
from protocol.software import version
from tests.own_checkout import CHECKOUT, copied_to, make

HOST = "mail.campus.example"
PACKAGE = "example.campus.mail"
STAND_IN = Path(__file__).with_name("android_stand_in.java")
LARGEST = 60_000
TOOLS = ("aapt", "apksigner", "keytool", "smali", "zipalign")
JVM_TOOLS = ("enjarify", "javac", "java")


def needs(*tools: str) -> pytest.MarkDecorator:
    """A test that is not run without these tools; CAMPUS_MAIL_REQUIRE_ANDROID, which CI sets, makes that a failure."""
    missing = [tool for tool in tools if not shutil.which(tool)]
    optional = not os.environ.get("CAMPUS_MAIL_REQUIRE_ANDROID")
    return pytest.mark.skipif(bool(missing) and optional, reason=f"{', '.join(missing)} missing: see .ci/run")


@dataclass(frozen=True)
class Built:
    """A package, what was printed of it, and the command lines of the tools that built it."""

    apk: Path
    printed: str
    commands: str

    @property
    def fingerprint(self) -> str:
        (found,) = re.findall(r"""^CAMPUS_MAIL_ANDROID_FINGERPRINTS='\["(.+)"\]'$""", self.printed, re.MULTILINE)
        return str(found)


def build(folder: Path, spied: Path) -> Built:
    """Build by the verb of the Makefile, with tools that write down how they are called."""
    spied.mkdir()
    for tool in TOOLS:
        spy = spied / tool
        spy.write_text(f'#!/bin/sh\necho "{tool} $*" >> {spied}/commands\nexec {shutil.which(tool)} "$@"\n')
        spy.chmod(0o755)
    made = subprocess.run(
        [
            "make",
            "--old-file=.venv/.python-ready",
            "android",
            f"HOST={HOST}",
            f"PACKAGE={PACKAGE}",
            f"ARGS=--folder {folder}",
        ],
        cwd=CHECKOUT,
        env=os.environ | {"PATH": f"{spied}:{os.environ['PATH']}"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert made.returncode == 0, made.stdout + made.stderr
    return Built(folder / f"{PACKAGE}.apk", made.stdout, (spied / "commands").read_text())


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Built:
    folder = tmp_path_factory.mktemp("android")
    return build(folder / "made", folder / "spied")


def said(*command: object) -> str:
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True).stdout


# What is built


@pytest.mark.slow
@needs(*TOOLS)
def test_the_package_is_signed_with_the_key_whose_fingerprint_is_printed(built: Built) -> None:
    folder = built.apk.parent
    certificate = subprocess.run(
        [
            "keytool",
            "-exportcert",
            "-keystore",
            folder / "key.p12",
            "-storepass:file",
            folder / "password",
            "-alias",
            "campus-mail",
        ],
        capture_output=True,
        check=True,
    ).stdout
    digest = hashlib.sha256(certificate).hexdigest()
    assert built.fingerprint == ":".join(re.findall("..", digest.upper()))
    verified = said("apksigner", "verify", "--verbose", "--print-certs", built.apk)
    assert digest in verified
    assert "(APK Signature Scheme v2): true" in verified
    assert built.apk.stat().st_size < LARGEST


@pytest.mark.slow
@needs(*TOOLS)
def test_a_package_with_a_changed_byte_is_refused(built: Built, tmp_path: Path) -> None:
    content = bytearray(built.apk.read_bytes())
    content[len(content) // 2] ^= 1
    changed = tmp_path / "changed.apk"
    changed.write_bytes(content)
    assert subprocess.run(["apksigner", "verify", changed], capture_output=True, check=False).returncode != 0


@pytest.mark.slow
@needs(*TOOLS)
def test_the_package_opens_the_host_and_says_that_it_belongs_to_it(built: Built) -> None:
    badging = said("aapt", "dump", "badging", built.apk)
    assert re.search(rf"^package: name='{PACKAGE}' versionCode='[1-9]\d*' versionName='{version()}'", badging)
    assert "application: label='Campus Mail' icon='res/mipmap-" in badging
    assert "launchable-activity: name='campus.mail.Launcher'" in badging
    assert "uses-permission" not in badging
    tree = said("aapt", "dump", "xmltree", built.apk, "AndroidManifest.xml")
    _, application = tree.split("E: application")
    _, activity = application.split("E: activity")
    launching, linked = activity.split("E: intent-filter")[1:]
    assert re.search(r"android:exported\(\w+\)=\(type 0x12\)0xffffffff", activity)
    assert "android.intent.category.LAUNCHER" in launching
    assert re.search(r"android:autoVerify\(\w+\)=\(type 0x12\)0xffffffff", linked)
    assert 'android:scheme(0x01010027)="https"' in linked
    assert f'android:host(0x01010028)="{HOST}"' in linked
    (strings,) = re.findall(r'"asset_statements".*\n.*android:resource\(\w+\)=@(0x\w+)', application)
    resources = said("aapt", "dump", "--values", "resources", built.apk)
    (statement,) = re.findall(rf"resource {strings} .*t=0x03.*\n *\(string8\) \"(.*)\"", resources)
    (web,) = json.loads(statement.replace('\\"', '"'))
    assert web["target"] == {"namespace": "web", "site": f"https://{HOST}"}


@pytest.mark.slow
@needs(*TOOLS)
def test_what_is_printed_is_what_the_service_answers_with_the_printed_settings(built: Built) -> None:
    assert f"CAMPUS_MAIL_ANDROID_PACKAGE={PACKAGE}\n" in built.printed
    printed, _ = json.JSONDecoder().raw_decode(built.printed[built.printed.index("\n[") + 1 :])
    assert printed == statements(PACKAGE, [built.fingerprint])
    assert "not been tried on a phone" in built.printed


@pytest.mark.nightly
@needs(*TOOLS)
def test_the_key_is_kept_and_its_password_is_on_no_command_line(built: Built, tmp_path: Path) -> None:
    folder = built.apk.parent
    password = (folder / "password").read_text()
    assert [oct((folder / name).stat().st_mode & 0o777) for name in ("", "key.p12", "password")] == [
        "0o700",
        "0o600",
        "0o600",
    ]
    again = build(folder, tmp_path / "spied")
    assert again.fingerprint == built.fingerprint
    assert "keytool -genkeypair" in built.commands
    assert "keytool" not in again.commands
    assert "apksigner sign" in again.commands
    assert password not in built.commands + again.commands + built.printed
    assert sorted(path.name for path in folder.iterdir()) == [f"{PACKAGE}.apk", "key.p12", "password"]


# How the launcher behaves

EXTRA = "android.support.customtabs.extra"
TRUSTED = f"with {{{EXTRA}.LAUNCH_AS_TRUSTED_WEB_ACTIVITY=true, {EXTRA}.SESSION=our callback}}"
PLAIN = "as android.intent.action.VIEW http:// android.intent.category.BROWSABLE"
ASKED = "ask 3 [android.support.customtabs.ICustomTabsService, our callback]"
FIRST = f"open android.intent.action.VIEW https://{HOST}/"
ORDER = f"https://{HOST}/one-order.html?x"


@pytest.fixture(scope="module")
def launcher(built: Built, tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """The command that runs the package's code on a JVM, which verifies all of it."""
    folder = tmp_path_factory.mktemp("jvm")
    parts = re.split(r"^// (\S+\.java)\n", STAND_IN.read_text(), flags=re.MULTILINE)[1:]
    for name, text in zip(parts[::2], parts[1::2], strict=True):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    said("javac", "-d", folder, *(folder / name for name in parts[::2]))
    # It runs by Debian's own Python, whatever comes first on the path.
    translate = ["enjarify", "-o", folder / "launcher.jar", built.apk]
    subprocess.run(translate, env=os.environ | {"PATH": "/usr/bin:/bin"}, capture_output=True, check=True)
    return ["java", "-Xverify:all", "-cp", f"{folder}:{folder}/launcher.jar", "android.app.Phone"]


@pytest.mark.slow
@needs(*TOOLS, *JVM_TOOLS)
@pytest.mark.parametrize(
    ("default_browser", "trusting", "answer", "state", "address", "wanted"),
    [
        (
            "b",
            "a,b",
            "yes",
            "new",
            "",
            ["bind b 1", ASKED, f"{FIRST} in b {TRUSTED}", ASKED, "back", "finish", "unbind"],
        ),
        (
            "c",
            "a,b",
            "yes",
            "new",
            "",
            ["bind a 1", ASKED, f"{FIRST} in a {TRUSTED}", ASKED, "back", "finish", "unbind"],
        ),
        (
            "",
            "a",
            "no",
            "new",
            "",
            ["bind a 1", ASKED, f"{FIRST} {PLAIN}", "finish", ASKED, "back", "finish", "unbind"],
        ),
        (
            "a",
            "a",
            "dead",
            "new",
            "",
            ["bind a 1", ASKED, f"{FIRST} {PLAIN}", "finish", ASKED, "back", "finish", "unbind"],
        ),
        ("a", "a", "null", "new", "", ["bind a 1", f"{FIRST} {PLAIN}", "finish", "back", "finish", "unbind"]),
        ("a", "a", "unbindable", "new", "", ["bind a 1", f"{FIRST} {PLAIN}", "finish", "back", "finish", "unbind"]),
        ("a", "", "none", "new", "", [f"{FIRST} {PLAIN}", "finish", "back", "finish"]),
        (
            "a",
            "",
            "none",
            "new",
            ORDER,
            [f"open android.intent.action.VIEW {ORDER} {PLAIN}", "finish", "back", "finish"],
        ),
        ("a", "", "none", "new", f"https://{HOST}.evil/", [f"{FIRST} {PLAIN}", "finish", "back", "finish"]),
        ("a", "", "none", "new", "file:///etc/hosts", [f"{FIRST} {PLAIN}", "finish", "back", "finish"]),
        ("a", "a", "none", "saved", "", ["finish", "back", "finish"]),
    ],
    ids=[
        "the default browser gives a session",
        "another browser supports it",
        "no session",
        "the browser dies",
        "no service behind the binding",
        "not bound",
        "no browser supports it",
        "an address of the host",
        "an address of another host",
        "a file",
        "come back to after its process ended",
    ],
)
def test_the_launcher_opens_the_pages_once(
    launcher: list[str], default_browser: str, trusting: str, answer: str, state: str, address: str, wanted: list[str]
) -> None:
    words = [default_browser, trusting, answer, state, *([address] if address else [])]
    assert said(*launcher, *words).splitlines() == wanted


# What is wrong is named


def run_build(host: str, package: str, folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "deploy.android", host, package, "--folder", folder],
        cwd=CHECKOUT,
        env=os.environ | environment,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize(
    ("host", "package", "wanted"),
    [
        ("https://mail.campus.example", PACKAGE, "HOST='https://mail.campus.example' is no host name"),
        ("mail.campus.example:8443", PACKAGE, "HOST='mail.campus.example:8443' is no host name"),
        ("", PACKAGE, "HOST='' is no host name; one looks like mail.campus.example"),
        ('a.b"/><evil', PACKAGE, "is no host name"),
        (HOST, "mail", "PACKAGE='mail' is no name of an Android app; one looks like example.campus.mail"),
        (HOST, "example.2nd", "PACKAGE='example.2nd' is no name"),
        (HOST, "", "PACKAGE is missing; one looks like example.campus.mail"),
    ],
)
def test_a_host_or_package_that_cannot_be_is_named(host: str, package: str, wanted: str) -> None:
    with pytest.raises(BuildError) as refused:
        checked(host, package)
    assert wanted in str(refused.value)


def test_what_is_wrong_is_one_sentence_and_nothing_is_made(tmp_path: Path) -> None:
    ran = run_build("mail", PACKAGE, tmp_path / "made")
    assert (ran.returncode, ran.stdout) == (1, "")
    assert ran.stderr.startswith("No Android package was built: HOST='mail' is no host name")
    assert len(ran.stderr.splitlines()) == 1
    assert not (tmp_path / "made").exists()


def test_missing_tools_are_named_with_their_debian_packages(tmp_path: Path) -> None:
    ran = run_build(HOST, PACKAGE, tmp_path / "made", PATH=str(tmp_path))
    assert ran.returncode == 1
    assert "aapt, apksigner, keytool, smali, zipalign" in ran.stderr
    assert "apt install aapt apksigner default-jre-headless libsmali-java zipalign" in ran.stderr


@pytest.mark.parametrize(("there", "gone"), [("key.p12", "password"), ("password", "key.p12")])
def test_half_a_key_is_never_replaced(tmp_path: Path, there: str, gone: str) -> None:
    (tmp_path / there).write_text("as it was")
    with pytest.raises(BuildError, match=f"{there} is there, but not .*{gone}"):
        key_in(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [there]
    assert (tmp_path / there).read_text() == "as it was"


def test_cleaning_up_keeps_the_key(tmp_path: Path) -> None:
    checkout = copied_to(tmp_path / "checkout")
    for name in ("var/android/key.p12", "var/sbom/service.json"):
        (checkout / name).parent.mkdir(parents=True)
        (checkout / name).touch()
    assert make(checkout, "clean").returncode == 0
    assert [path.name for path in (checkout / "var").iterdir()] == ["android"]
    assert (checkout / "var/android/key.p12").exists()
