"""`mend run`: one run of a task tree, told live; without a service, or in one that is there."""

import asyncio
import os
import sys
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from mend.server.cli.asked_service import SERVICE
from mend.server.cli.failures import INTERRUPTED, CommandLineError, told_plainly
from mend.server.cli.talk import TOKEN_VARIABLE


def run(
    tree: Annotated[
        str, typer.Argument(metavar="TREE", help="A task tree: its name (`mend trees`) or a file.")
    ],
    world: Annotated[
        str,
        typer.Option(
            help="Where: workcell, tabletop, a world of yours, or live: robots that connect."
        ),
    ] = "workcell",
    robot: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="World live: the name of a robot that connects; may be given several times. "
            "PLACE=NAME says which robot of the scene it is (docs/live_robots.md).",
        ),
    ] = None,
    wait: Annotated[
        float, typer.Option(min=0.0, help="World live: for so many seconds robots are waited for.")
    ] = 60.0,
    url: Annotated[
        str | None,
        typer.Option(help="Have the service at this address do it, and keep the files there."),
    ] = None,
    site: Annotated[
        str | None,
        typer.Option(
            help="Do it at this site of the service (`mend site list`), which says the world, the "
            f"scene, the speed and the seed. Without --url the service is at {SERVICE}."
        ),
    ] = None,
    token: Annotated[
        str | None, typer.Option(help="That service's token; better given as MEND_TOKEN.")
    ] = None,
    scene: Annotated[
        str | None,
        typer.Option(
            help="Do it in this scene: its name (`mend scenes`) or a file. Without it, in the one "
            "that the tree is for."
        ),
    ] = None,
    scenario: Annotated[
        str | None,
        typer.Option(help="What happens meanwhile: its name (`mend scenarios`) or a file."),
    ] = None,
    speed: Annotated[
        str, typer.Option(help="Simulated seconds per second, or max for as fast as possible.")
    ] = "1.0",
    seed: Annotated[int, typer.Option(help="Makes every chance in the run repeatable.")] = 0,
    answers: Annotated[
        str | None,
        typer.Option(
            help="The helper's answers in turn (yes,no,silence,...); random: by the seed; none: "
            "nobody answers. Without it the scenario's answers, else you at the terminal."
        ),
    ] = None,
    interventions: Annotated[
        str | None, typer.Option(help="random: a person steals, moves and blocks, by the seed.")
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print every event as a JSON line, and nothing else.")
    ] = False,
    report: Annotated[
        Path | None, typer.Option(help="Write a report of the run to this HTML file.")
    ] = None,
    journal: Annotated[
        Path | None, typer.Option(help="The journal's file; otherwise one of the run's own.")
    ] = None,
    option: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE",
            help="What the world has to choose (docs/worlds.md), such as camera_noise=4; may be "
            "given several times.",
        ),
    ] = None,
    max_attempts: Annotated[
        int, typer.Option(help="After so many failed attempts a leaf is given up.")
    ] = 3,
    person: Annotated[
        bool | None,
        typer.Option(
            "--person/--no-person",
            help="Whether a simulated person does what the helper promised.",
        ),
    ] = None,
) -> None:
    """Run a task tree in a simulated world, or on robots that connect, and print what happens.

    The exit code is 0 only if the task finished; 1 if it failed, 2 if it could not begin. A task
    also finishes without a part that a helper said to leave out; the last line names it, and who
    said so. Ctrl-C aborts the run.
    """
    from mend.server.cli.live_run import LiveRun
    from mend.server.cli.other_service import other_service
    from mend.server.cli.output import JsonLines, LiveTranscript
    from mend.server.cli.own_service import own_service
    from mend.server.cli.report_file import require_writable
    from mend.server.cli.run_files import read_run_files
    from mend.server.cli.run_host import OpenHost
    from mend.server.cli.run_request import (
        answers_given,
        checked_request,
        read_options,
        read_robots,
        read_speed,
        settings_of_its_own,
    )
    from mend.server.errors import ImpossibleError
    from mend.server.runtime.ports import LIVE
    from mend.server.runtime.requests import RunRequest
    from mend.tasks.scenario import Person

    with told_plainly():
        if site is not None:
            url = url or SERVICE
        files = read_run_files(tree, scene, scenario)
        given = answers_given(answers, files.scenario)
        asks_at_terminal = given is None and sys.stdin.isatty() and not json
        # Where others can come to the service, they may answer too.
        nobody_answers = not (asks_at_terminal or world == LIVE or url)
        request = checked_request(
            RunRequest,
            tree=files.tree,
            world=world,
            scene=files.scene,
            scenario=files.scenario.name if files.scenario else None,
            speed=read_speed(speed),
            seed=seed,
            answers="none" if given is None and nobody_answers else given,
            interventions=interventions,
            max_attempts=max_attempts,
            world_options=read_options(option or []),
            robots=read_robots(robot or []),
            person=None if person is None else Person(acts=person),
        )
        if report is not None:
            require_writable(report)
        open_host: OpenHost
        if url is None:
            # All of a service, which one that only asks another has no use for.
            from mend.server.composition import open_service

            settings = settings_of_its_own(journal, files, takes_robots=world == LIVE)
            open_host = partial(own_service, open_service, settings, files.given)
        elif journal is None:
            given_token = token or os.environ.get(TOKEN_VARIABLE)
            open_host = partial(other_service, url, given_token, files.given, site)
        else:
            raise CommandLineError("--journal is for a run without --url: a service has its own")
        live_run = LiveRun(
            open_host,
            request,
            JsonLines() if json else LiveTranscript(),
            report,
            asks_at_terminal=asks_at_terminal,
            wait_s=wait,
        )
        try:
            exit_code = asyncio.run(live_run.carry_out())
        except ImpossibleError as error:
            told = [str(error), *files.described(error.scene_problems)]
            raise CommandLineError("\n".join(told)) from error
        except KeyboardInterrupt:
            raise CommandLineError("interrupted", INTERRUPTED) from None
    raise typer.Exit(exit_code)
