"""Sites at the command line: opened, listed, shown, used by a run, and closed."""

import asyncio
import os
import sys
from dataclasses import dataclass
from pathlib import Path

from service_process import ServiceProcess, service_process

from mend.server.client import MendClient

MEND = str(Path(sys.executable).with_name("mend"))
PATIENCE_S = 120.0


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a command came to."""

    code: int | None
    told: str
    complaints: str


async def mend(service: ServiceProcess, *arguments: str) -> Outcome:
    """A command that asks a service."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("MEND_")}
    process = await asyncio.create_subprocess_exec(
        MEND, *arguments, "--url", service.url,
        env=kept, stdin=asyncio.subprocess.DEVNULL,
        stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
    )  # fmt: skip
    async with asyncio.timeout(PATIENCE_S):
        told, complaints = await process.communicate()
    return Outcome(process.returncode, told.decode(), complaints.decode())


TABLETOP = ("--world", "tabletop", "--speed", "max")


async def test_a_run_is_done_at_a_site_that_was_opened(tmp_path: Path) -> None:
    async with service_process(tmp_path) as service:
        opened = await mend(service, "site", "open", "kit", *TABLETOP)
        site = opened.told.strip()
        assert (opened.code, opened.complaints) == (0, "")
        listed = await mend(service, "site", "list")
        assert listed.told.startswith(f"{site}\tkit\ttabletop\t")
        assert listed.told.endswith("\t1 of 1\n")
        ran = await mend(service, "run", "kit", "--site", site[:8], "--answers", "none")
        assert (ran.code, ran.complaints) == (0, "")
        assert "the run has finished: the task is done" in ran.told
        async with MendClient(service.url) as client:
            (run,) = await client.runs()
            assert (await client.run(run.id)).options["site"] == site
        shown = await mend(service, "site", "show", "kit")
        assert shown.told.startswith(f"site {site}: kit in tabletop (seed 0, speed max)\n")
        assert f"pr2-{site[:8]} (pr2): connected, free" in shown.told
        assert " is at " in shown.told.splitlines()[-1]
        closed = await mend(service, "site", "close", site)
        assert (closed.code, closed.told) == (0, f"site {site} is closed\n")
        assert (await mend(service, "site", "list")).told == ""


async def test_what_is_not_there_is_said_in_a_sentence(tmp_path: Path) -> None:
    async with service_process(tmp_path) as service:
        nowhere = await mend(service, "run", "kit", "--site", "kit")
        assert (nowhere.code, nowhere.complaints) == (
            2,
            "mend: no site 'kit' is open; open are: none\n",
        )
        for _ in range(2):
            assert (await mend(service, "site", "open", "kit", *TABLETOP)).code == 0
        either = await mend(service, "site", "show", "kit")
        assert either.code == 2
        assert "'kit' may be any of the sites" in either.complaints
        unknown = await mend(service, "site", "open", "nowhere", *TABLETOP)
        assert (unknown.code, unknown.complaints.count("\n")) == (2, 1)
        wrong = await mend(service, "site", "open", "kit", "--seed", "-1")
        assert wrong.complaints.startswith("mend: --seed must be greater than or equal to 0")
