"""Cookies: `__Host-` on https, which no other host and no other path can set; a plain name on this machine alone."""

from fastapi import Request, Response


def cookie_name(request: Request, name: str) -> str:
    """`__Host-` cookies exist on https alone; localhost makes do with a plain one."""
    return f"__Host-{name}" if request.url.scheme == "https" else name


def read_cookie(request: Request, name: str) -> str:
    """Empty if there is none."""
    return request.cookies.get(cookie_name(request, name), "")


def set_cookie(request: Request, response: Response, name: str, value: str, max_age_s: int) -> None:
    """Out of reach of scripts and of other sites' requests, but for links that lead here. 0 s take it away."""
    response.set_cookie(
        cookie_name(request, name),
        value,
        max_age=max_age_s,
        path="/",
        httponly=True,
        samesite="lax",
        secure=request.url.scheme == "https",
    )
