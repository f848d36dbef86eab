"""JSON bodies read strictly, and beside the event loop where there is much to read."""

from collections.abc import Callable, Coroutine
from typing import Any

from fastapi.routing import APIRoute
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

from mend.errors import RefusalError
from mend.server.api.json_text import NotJsonError, TooManyValuesError, may_have, read_json
from mend.server.api.problems import ProblemError
from mend.server.api.services import services_of
from mend.server.off_loop import MUCH_CHARS

OTHER_VALUES = 1000
"""So many values a body may have beside scripted answers and options of a world."""


class StrictJsonRequest(Request):
    """A request whose JSON is refused where Python's reader is more generous than the standard."""

    async def json(self) -> Any:
        body = await self.body()
        services = services_of(self)
        limits = services.settings.limits
        most = OTHER_VALUES + limits.answers + limits.world_options
        chars = max(len(body), MUCH_CHARS) if may_have(body, most) else len(body)
        try:
            if chars < MUCH_CHARS:
                return read_json(body, most)
            return await services.off_loop.run(chars, read_json, body, most)
        except NotJsonError as error:
            raise ProblemError(400, str(error)) from None
        except TooManyValuesError as error:
            raise ProblemError(413, str(error), limit="body_values") from None


class StrictJsonRoute(APIRoute):
    """A route that reads its body strictly."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        handle = super().get_route_handler()

        async def handle_strictly(request: Request) -> Response:
            try:
                return await handle(StrictJsonRequest(request.scope, request.receive))
            except HTTPException as error:
                # What goes wrong with a body is told as one thing, whatever it was.
                if isinstance(error.__cause__, ProblemError | RefusalError):
                    raise error.__cause__ from None
                raise

        return handle_strictly
