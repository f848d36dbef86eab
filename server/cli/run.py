"""`mend run`: one run of a task tree, without a server, told live."""

import asyncio
import sys
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from mend.server.cli.failures import CommandLineError, told_plainly


def run(
    tree: Annotated[
        str, typer.Argument(metavar="TREE", help="A task tree: its name (`mend trees`) or a file.")
    ],
    world: Annotated[str, typer.Option(help="Where: workcell, tabletop or a world of yours.")] = (
        "workcell"
    ),
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
    """Run a task tree in a simulated world, and print what happens.

    The exit code is 0 only if the task finished; 1 if it failed, 2 if it could not begin. A task
    also finishes without a part that a helper said to leave out; the last line names it, and who
    said so. Ctrl-C aborts the run.
    """
    from mend.server.cli.live_run import LiveRun
    from mend.server.cli.output import JsonLines, LiveTranscript
    from mend.server.cli.run_files import read_run_files
    from mend.server.cli.run_request import (
        answers_given,
        read_options,
        read_request,
        read_speed,
        settings_of_its_own,
    )
    from mend.server.composition import open_service
    from mend.server.errors import ImpossibleError
    from mend.tasks.scenario import Person

    with told_plainly():
        files = read_run_files(tree, scene, scenario)
        given = answers_given(answers, files.scenario)
        asks_at_terminal = given is None and sys.stdin.isatty() and not json
        request = read_request(
            tree=files.tree,
            world=world,
            scene=files.scene,
            scenario=files.scenario.name if files.scenario else None,
            speed=read_speed(speed),
            seed=seed,
            answers="none" if given is None and not asks_at_terminal else given,
            interventions=interventions,
            max_attempts=max_attempts,
            world_options=read_options(option or []),
            person=None if person is None else Person(acts=person),
        )
        if report is not None:
            # A report that cannot be written is told before the run, not after it.
            report.parent.mkdir(parents=True, exist_ok=True)
        settings = settings_of_its_own(journal, files)
        output = JsonLines() if json else LiveTranscript()
        live_run = LiveRun(
            partial(open_service, given=files.given),
            settings,
            request,
            output,
            report,
            asks_at_terminal=asks_at_terminal,
        )
        try:
            exit_code = asyncio.run(live_run.carry_out())
        except ImpossibleError as error:
            told = [str(error), *files.described(error.scene_problems)]
            raise CommandLineError("\n".join(told)) from error
    raise typer.Exit(exit_code)
