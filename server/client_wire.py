"""What every call of the client goes over: one connection, and refusals as errors."""

import asyncio
from collections.abc import Awaitable
from types import TracebackType
from typing import Any, Self, TypeVar

import httpx
from pydantic import TypeAdapter, ValidationError

from mend.server.api.problem import Problem, problem
from mend.server.client_errors import RefusedError, UnreachableError
from mend.server.client_retries import send_once
from mend.server.journal.trouble import Sleep

T = TypeVar("T")

IDLE_S = 2.0
"""An idle connection is let go after so long: a request on one that the service is just closing
would be lost."""


class Wire:
    """Asks one service. Every call raises `RefusedError` or `UnreachableError`."""

    def __init__(
        self,
        url: str,
        *,
        token: str | None = None,
        timeout_s: float = 30.0,
        sleep: Sleep = asyncio.sleep,
    ) -> None:
        self._sleep = sleep
        self._url = url.rstrip("/")
        self._headers = {"Authorization": f"Bearer {token}"} if token else {}
        self._http = httpx.AsyncClient(
            base_url=self._url,
            headers=self._headers,
            timeout=timeout_s,
            # Without TLS there is nobody to verify: reading all authorities would take for nothing.
            verify=not self._url.lower().startswith("http:"),
            limits=httpx.Limits(keepalive_expiry=IDLE_S),
        )

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        await self._http.aclose()

    async def _get(self, path: str, shape: type[T], **parameters: Any) -> T:
        given = {name: value for name, value in parameters.items() if value is not None}
        response = await self._request("GET", path, params=given)
        return TypeAdapter(shape).validate_json(response.content)

    async def _post(self, path: str, shape: type[T], body: Any = None) -> T:
        response = await self._answer(
            send_once(
                lambda headers: self._http.post(path, json=body, headers=headers), self._sleep
            )
        )
        return TypeAdapter(shape).validate_json(response.content)

    async def _request(self, method: str, path: str, **more: Any) -> httpx.Response:
        return await self._answer(self._http.request(method, path, **more))

    async def _answer(self, sent: Awaitable[httpx.Response]) -> httpx.Response:
        try:
            response = await sent
        except httpx.HTTPError as error:
            raise UnreachableError(f"no service answers at {self._url}: {error}") from error
        if response.is_error:
            raise RefusedError(_problem_in(response))
        return response


def _problem_in(response: httpx.Response) -> Problem:
    try:
        return Problem.model_validate_json(response.content)
    except ValidationError:
        return problem(response.status_code, response.text[:200] or "the service said no more")
