"""The command line in this process: each of its own would take as long to begin as all else."""

import asyncio
import os
import sys
from collections.abc import Awaitable, Callable
from dataclasses import dataclass

import pytest

from mend.server.cli import main


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a command came to."""

    code: int | None
    told: str
    complaints: str


Command = Callable[..., Awaitable[Outcome]]
"""`await command(url, *arguments)`: a command of `mend` with them, which asks a service."""


def command_of(
    name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Command:
    """`mend NAME`, in an environment without settings."""
    for each in [each for each in os.environ if each.startswith("MEND_")]:
        monkeypatch.delenv(each)

    async def call(url: str, *arguments: str) -> Outcome:
        monkeypatch.setattr(sys, "argv", ["mend", name, *arguments, "--url", url])
        code = await asyncio.to_thread(_exit_code)
        captured = capsys.readouterr()
        return Outcome(code, captured.out, captured.err)

    return call


def _exit_code() -> int:
    with pytest.raises(SystemExit) as ended:
        main()
    return int(ended.value.code or 0)
