"""JSON bodies as the standard has them: no NaN, no infinity, no nesting without end."""

import json
import math
from collections.abc import Callable, Coroutine
from typing import Any, NoReturn

from fastapi.routing import APIRoute
from starlette.requests import Request
from starlette.responses import Response

from server.api.problems import ProblemError


class StrictJsonRequest(Request):
    """A request whose JSON is refused where Python's reader is more generous than the standard."""

    async def json(self) -> Any:
        body = await self.body()
        try:
            return json.loads(body.decode("utf-8"), parse_constant=_refuse, parse_float=_finite)
        except json.JSONDecodeError:
            raise
        except UnicodeDecodeError as error:
            raise ProblemError(400, f"the body is not UTF-8: byte {error.start} is wrong") from None
        except (ValueError, RecursionError) as error:
            raise ProblemError(400, f"the body cannot be read: {error}") from None


class StrictJsonRoute(APIRoute):
    """A route that reads its body strictly."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        handle = super().get_route_handler()

        async def handle_strictly(request: Request) -> Response:
            return await handle(StrictJsonRequest(request.scope, request.receive))

        return handle_strictly


def _refuse(constant: str) -> NoReturn:
    raise ValueError(f"{constant} is not JSON")


def _finite(number: str) -> float:
    value = float(number)
    if math.isinf(value):
        raise ValueError("a number is too large")
    return value
