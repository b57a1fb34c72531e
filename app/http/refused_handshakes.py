"""A WebSocket that is refused before it opens is answered as any other request: by a problem document."""

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.core.errors import problem_answer

CAN_ANSWER = "websocket.http.response"


class RefusedHandshakes:
    """Where there is no such socket 404; where a route has said no, 403 with what it said."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "websocket" or CAN_ANSWER not in scope.get("extensions", {}):
            await self._app(scope, receive, send)
            return
        is_open = False

        async def send_or_answer(message: Message) -> None:
            nonlocal is_open
            if message["type"] == "websocket.close" and not is_open:
                await _refusal(scope, message, receive, send)
                return
            is_open = is_open or message["type"] == "websocket.accept"
            await send(message)

        await self._app(scope, receive, send_or_answer)


async def _refusal(scope: Scope, message: Message, receive: Receive, send: Send) -> None:
    if "endpoint" not in scope:
        answer = problem_answer(404, "not_found", "There is no socket here.")
    else:
        answer = problem_answer(403, "forbidden", message.get("reason") or "This connection is refused.")
    await answer(scope, receive, send)
