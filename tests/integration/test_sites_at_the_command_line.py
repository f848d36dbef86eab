"""Sites at the command line: opened, listed, shown, used by a run, and closed."""

from pathlib import Path

import pytest
from console_script import Command, Outcome, command_of
from forked_mend import FORKED, mend_command
from service_process import ServiceProcess, service_process

from mend.server.client import MendClient


@pytest.fixture
def site(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Command:
    return command_of("site", monkeypatch, capsys)


async def run(service: ServiceProcess, *arguments: str) -> Outcome:
    """`mend run` in a process of its own."""
    async with mend_command("run", *arguments, "--url", service.url) as command:
        return Outcome(*await command.outcome())


TABLETOP = ("--world", "tabletop", "--speed", "max")


@pytest.mark.slow(2)
async def test_a_run_is_done_at_a_site_and_what_is_not_there_is_said_in_a_sentence(
    site: Command, tmp_path: Path
) -> None:
    async with service_process(tmp_path, forked=FORKED) as service:
        nowhere = await run(service, "order", "--site", "order")
        assert (nowhere.code, nowhere.complaints) == (
            2,
            "mend: no site 'order' is open; open are: none\n",
        )
        opened = await site(service.url, "open", "order", *TABLETOP)
        name = opened.told.strip()
        assert (opened.code, opened.complaints) == (0, "")
        listed = await site(service.url, "list")
        assert listed.told.startswith(f"{name}\torder\ttabletop\t")
        assert listed.told.endswith("\t1 of 1\n")
        ran = await run(service, "order", "--site", name[:8], "--answers", "none")
        assert (ran.code, ran.complaints) == (0, "")
        assert "the run has finished: the task is done" in ran.told
        async with MendClient(service.url) as client:
            (done,) = await client.runs()
            assert (await client.run(done.id)).options["site"] == name
        shown = await site(service.url, "show", "order")
        assert shown.told.startswith(f"site {name}: order in tabletop (seed 0, speed max)\n")
        assert f"pr2-{name[:8]} (pr2): connected, free" in shown.told
        assert " is at " in shown.told.splitlines()[-1]
        closed = await site(service.url, "close", name)
        assert (closed.code, closed.told) == (0, f"site {name} is closed\n")
        assert (await site(service.url, "list")).told == ""

        for _ in range(2):
            assert (await site(service.url, "open", "order", *TABLETOP)).code == 0
        either = await site(service.url, "show", "order")
        assert either.code == 2
        assert "'order' may be any of the sites" in either.complaints
        unknown = await site(service.url, "open", "nowhere", *TABLETOP)
        assert (unknown.code, unknown.complaints.count("\n")) == (2, 1)
        wrong = await site(service.url, "open", "order", "--seed", "-1")
        assert wrong.complaints.startswith("mend: --seed must be greater than or equal to 0")
