"""Marker sheets of posts and bays, for the printer: the drawing of `python -m maps markers`, one place at a time."""

from typing import Annotated, Any, Final

from fastapi import APIRouter, Path, Response

from app.accounts.current_user import DispatcherOrMaintainer
from app.accounts.errors import RoleNeeded
from app.core.errors import NotFound, problems
from app.core.settings import CampusDep
from maps import UnknownPost
from maps.sheets import marker_sheet

router = APIRouter(tags=["dispatch"])

SHEET: Final[dict[int | str, dict[str, Any]]] = {200: {"content": {"image/svg+xml": {"schema": {"type": "string"}}}}}
NameOfPost = Annotated[str, Path(pattern=r"^[A-Za-z][A-Za-z0-9_]*$", max_length=64)]


class NoSuchPost(NotFound):
    """The campus map has no post or bay of this name."""

    code = "no_such_post"


@router.get(
    "/map/posts/{post}/marker.svg",
    response_class=Response,
    responses={**SHEET, **problems(NoSuchPost, RoleNeeded)},
)
async def marker_picture(post: NameOfPost, user: DispatcherOrMaintainer, campus: CampusDep) -> Response:
    """The marker sheet of a post or bay (SVG, 148 × 210 mm, to be printed at 100 %), as often as it says."""
    try:
        found = campus.track.post(post)
    except UnknownPost as error:
        raise NoSuchPost(str(error)) from None
    return Response(marker_sheet(found), media_type="image/svg+xml")
