"""Android learns from the service which app may open its pages without an address bar."""

import pytest
from fastapi.testclient import TestClient

from app.core.settings import Settings

ASSET_LINKS = "/.well-known/assetlinks.json"
FINGERPRINTS = (":".join(["AB"] * 32), ":".join(["CD"] * 32))


@pytest.fixture
def settings(settings: Settings) -> Settings:
    return Settings(**settings.model_dump() | {"android_package": "a.b_2", "android_fingerprints": FINGERPRINTS})


def test_the_app_and_each_certificate_it_may_be_signed_with_are_named(anonymous: TestClient) -> None:
    answer = anonymous.get(ASSET_LINKS)
    assert (answer.status_code, answer.headers["content-type"]) == (200, "application/json")
    (statement,) = answer.json()
    assert statement == {
        "relation": ["delegate_permission/common.handle_all_urls"],
        "target": {
            "namespace": "android_app",
            "package_name": "a.b_2",
            "sha256_cert_fingerprints": list(FINGERPRINTS),
        },
    }
