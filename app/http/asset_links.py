"""Which Android app may open these pages as its own (Digital Asset Links)."""

from collections.abc import Sequence
from typing import Any

from fastapi import APIRouter
from fastapi.responses import JSONResponse

from app.core.errors import problem_answer
from app.core.settings import SettingsDep

router = APIRouter(tags=["about"])

OPENS_ALL_ADDRESSES = "delegate_permission/common.handle_all_urls"


def statements(package: str, fingerprints: Sequence[str]) -> list[dict[str, Any]]:
    """Return the content of assetlinks.json: one app, signed with any of these certificates (SHA-256, as AB:CD:…)."""
    target = {
        "namespace": "android_app",
        "package_name": package,
        "sha256_cert_fingerprints": list(fingerprints),
    }
    return [{"relation": [OPENS_ALL_ADDRESSES], "target": target}]


@router.get("/.well-known/assetlinks.json", include_in_schema=False, response_model=None)
async def asset_links(settings: SettingsDep) -> JSONResponse:
    """Answer Android before it shows the pages without an address bar; 404 as long as there is no app."""
    if not (settings.android_package and settings.android_fingerprints):
        return problem_answer(404, "not_found", "No Android app belongs to this service.")
    return JSONResponse(statements(settings.android_package, settings.android_fingerprints))
