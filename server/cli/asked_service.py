"""The service that a command asks: its options, and what it answers."""

import asyncio
import os
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, TypeVar

import typer

from mend.server.cli.failures import told_plainly
from mend.server.cli.talk import TOKEN_VARIABLE

if TYPE_CHECKING:
    from mend.server.client import MendClient

T = TypeVar("T")

SERVICE = "http://127.0.0.1:8080"


@dataclass(frozen=True, slots=True)
class AskedService:
    """A service that is there; options of a command (`shared_options`)."""

    url: Annotated[str, typer.Option(help="The service.")] = SERVICE
    token: Annotated[
        str | None, typer.Option(help="The service's token; better given as MEND_TOKEN.")
    ] = None

    def asked(self, ask: "Callable[[MendClient], Awaitable[T]]") -> T:
        """What it answers. Raises `CommandLineError`."""
        from mend.server.client import MendClient

        async def asked() -> T:
            token = self.token or os.environ.get(TOKEN_VARIABLE)
            async with MendClient(self.url, token=token) as client:
                return await ask(client)

        with told_plainly():
            return asyncio.run(asked())
