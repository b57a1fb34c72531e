"""Requests by route and status, and how long they took, for `/metrics`; streams count when they begin to answer.

The route is the one that has answered: to look for it anew, as libraries do, takes as long as all routes before it.
"""

import time
from typing import Final

from fastapi import FastAPI
from prometheus_client import CollectorRegistry, Counter, Histogram
from starlette.types import ASGIApp, Message, Receive, Scope, Send

NOT_COUNTED: Final = frozenset({"/metrics", "/healthz"})
FINE: Final = (0.005, 0.01, 0.025, 0.05, 0.075, 0.1, 0.25, 0.5, 0.75, 1, 1.5, 2, 3, 5, 10, 30, 60)
COARSE: Final = (0.1, 0.5, 1)
OTHER: Final = "other"
"""Each word that is counted by itself is kept for good, and anybody may make up methods."""


class RequestFigures:
    """Counts what comes through; what leads to no route is not counted, because anybody may ask for anything."""

    def __init__(self, app: ASGIApp, registry: CollectorRegistry) -> None:
        self._app = app
        name, by_route = "campus_mail_http_request", ("handler", "method")
        total, took = "Requests by route, method and status.", "Until the answer began"
        self._total = Counter(f"{name}s", total, (*by_route, "status"), registry=registry)
        self._all_took = Histogram(f"{name}_duration_highr_seconds", f"{took}.", buckets=FINE, registry=registry)
        by_name = f"{name}_duration_seconds"
        self._took = Histogram(by_name, f"{took}, by route.", by_route, buckets=COARSE, registry=registry)
        self._paths: dict[int, str] = {}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        begun_s, took_s, status = time.perf_counter(), None, 500

        async def send_timed(message: Message) -> None:
            nonlocal took_s, status
            if message["type"] == "http.response.start":
                took_s, status = time.perf_counter() - begun_s, message["status"]
            await send(message)

        try:
            await self._app(scope, receive, send_timed)
        finally:
            self._count(scope, status, time.perf_counter() - begun_s if took_s is None else took_s)

    def _count(self, scope: Scope, status: int, took_s: float) -> None:
        path = self._path_of(scope)
        if path is None or path in NOT_COUNTED:
            return
        method = scope["method"] if scope["method"] in scope["route"].methods else OTHER
        self._total.labels(path, method, f"{status // 100}xx").inc()
        self._all_took.observe(took_s)
        self._took.labels(path, method).observe(took_s)

    def _path_of(self, scope: Scope) -> str | None:
        """As it stands in the API's document, with all that it was included under."""
        route = scope.get("route")
        if route is not None and not self._paths:
            self._paths = _paths_of(scope["app"])
        return self._paths.get(id(route), getattr(route, "path", None))


def _paths_of(app: FastAPI) -> dict[int, str]:
    paths: dict[int, str] = {}
    for included in app.routes:
        contexts = getattr(included, "effective_route_contexts", None)
        for one in contexts() if contexts else ():
            paths[id(one.original_route)] = one.path
    return paths
