"""The image is built, starts and is healthy; compose.yaml opens the proxy alone.

buildah runs the Dockerfile's steps and the finished image in a chroot: no container engine, and a bare Debian stands in
for the `python:slim` image, which may not be fetched here. Limits of memory, networks and volumes are not tested.
"""

import json
import os
import shutil
import ssl
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
import yaml

from tests.system.rig import free_port, wait_for

ROOT = Path(__file__).parents[2]
PATH = f"{os.environ['PATH']}:/usr/sbin"
MISSING = [name for name in ("buildah", "debootstrap") if shutil.which(name, path=PATH) is None]
SETTINGS = {"CAMPUS_MAIL_PUBLIC_URL": "https://mail.campus.example", "DATABASE_PASSWORD": "not-a-secret"}


class Store:
    """Images and containers in a folder of their own."""

    def __init__(self, folder: Path) -> None:
        self._buildah = ["buildah", "--storage-driver=vfs", f"--root={folder}/images", f"--runroot={folder}/run"]

    def command(self, verb: str, *arguments: str | Path) -> list[str]:
        isolation = ["--isolation=chroot"] if verb in {"bud", "run"} else []
        return [*self._buildah, verb, *isolation, *map(str, arguments)]

    def run(self, verb: str, *arguments: str | Path) -> str:
        return _output(*self.command(verb, *arguments))


@pytest.fixture(scope="module")
def store() -> Iterator[Store]:
    """An image `localhost/campus-mail`, built on a bare Debian with Python."""
    with tempfile.TemporaryDirectory() as folder:
        store, debian = Store(Path(folder)), Path(folder, "debian")
        _output("debootstrap", "--variant=minbase", "--include=ca-certificates,python3,python3-venv", "trixie", debian)
        (debian / "usr/bin/python").symlink_to("python3")
        authorities = "/etc/ssl/certs/ca-certificates.crt"
        shutil.copyfile(ssl.get_default_verify_paths().cafile or authorities, f"{debian}{authorities}")
        base = store.run("from", "scratch").strip()
        store.run("copy", "--quiet", base, debian, "/")
        store.run("config", f"--env=NODE_EXTRA_CA_CERTS={authorities}", base)
        store.run("commit", "--quiet", "--rm", base, "localhost/base")
        shutil.rmtree(debian)
        options = ("--format=docker", "--pull-never", "--layers=false", "--build-arg=BASE=localhost/base")
        store.run("bud", *options, "--tag=localhost/campus-mail", ROOT)
        yield store


@pytest.mark.nightly
@pytest.mark.timeout(1200)
@pytest.mark.skipif(bool(MISSING), reason=f"missing Debian packages: {', '.join(MISSING)}")
@pytest.mark.skipif(os.geteuid() != 0, reason="debootstrap and chroot need root")
def test_the_image_starts_as_another_user_and_its_health_check_tells_whether_it_serves(store: Store) -> None:
    config = json.loads(store.run("inspect", "--type=image", "localhost/campus-mail"))["Docker"]["config"]
    port = free_port()
    container = store.run("from", "--pull-never", "localhost/campus-mail").strip()

    def inside(*words: str) -> list[str]:
        return store.command("run", f"--env=CAMPUS_MAIL_PORT={port}", container, "--", *words)

    def succeeds(*words: str) -> bool:
        """Of its output buildah loses some at times."""
        return subprocess.run(inside(*words), capture_output=True, check=False).returncode == 0

    def healthy() -> bool:
        return succeeds(*config["Healthcheck"]["Test"][1:])

    assert succeeds("sh", "-c", "test $(id -u) = 10001")
    assert succeeds("pg_dump", "--version")
    assert list(config["Volumes"]) == ["/var/lib/campus-mail"]
    assert not healthy()
    with subprocess.Popen(inside(*config["Cmd"]), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as service:
        try:
            wait_for("the health check", healthy, 60)
            for page in ("/", "/npm/joined/lit.js"):
                assert httpx.get(f"http://127.0.0.1:{port}{page}").status_code == 200, page
        finally:
            service.terminate()


def test_only_the_proxy_is_open_and_the_service_believes_its_network_alone() -> None:
    compose = yaml.safe_load((ROOT / "compose.yaml").read_text())
    services = compose["services"]
    assert [name for name, one in services.items() if "ports" in one or "network_mode" in one] == ["proxy"]
    assert [name for name, one in services.items() if "front" in one["networks"]] == ["proxy", "service"]
    (front,) = compose["networks"]["front"]["ipam"]["config"]
    assert json.loads(services["service"]["environment"]["CAMPUS_MAIL_TRUSTED_PROXIES"]) == [front["subnet"]]
    assert compose["networks"]["back"]["internal"]


@pytest.mark.skipif(shutil.which("docker-compose") is None, reason="docker-compose is missing (Debian package)")
def test_compose_accepts_the_file_and_asks_for_what_is_not_set(tmp_path: Path) -> None:
    shutil.copy(ROOT / "compose.yaml", tmp_path)
    for left_out in (None, *SETTINGS):
        (tmp_path / ".env").write_text("".join(f"{k}={v}\n" for k, v in SETTINGS.items() if k != left_out))
        ran = subprocess.run(
            ["docker-compose", "config", "--quiet"], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        assert (ran.returncode == 0) == (left_out is None), ran.stderr
        assert left_out is None or left_out in ran.stderr


def _output(*command: str | Path) -> str:
    ran = subprocess.run(command, env=os.environ | {"PATH": PATH}, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr[-3000:]
    return ran.stdout
