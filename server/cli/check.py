"""`mend check`: every mistake of a task, scene, scenario or delivery file."""

import json
import re
from pathlib import Path
from typing import Annotated

import typer

from mend.server.cli.failures import NOT_FINISHED, CommandLineError, told_plainly

DELIVERY_KEYS = {"travel", "robots", "items"}
SCENE_KEYS = {"objects", "places"}
SCENARIO_KEYS = {"interventions", "answers", "answer_delay_s", "person"}
TOP_LEVEL_KEY = re.compile(r"""^["']?(\w+)["']?[ \t]*:""", re.MULTILINE)
TREE_BY_NAME = re.compile(r"""^["']?tree["']?[ \t]*:[ \t]*["']?\w""", re.MULTILINE)


def check(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE", help="A task, scene, scenario or delivery file, YAML or JSON."
        ),
    ],
    world: Annotated[
        str | None,
        typer.Option(
            help="The world whose robot has to be able to do it; without it, every world that can "
            "run here."
        ),
    ] = None,
    tree: Annotated[
        str | None,
        typer.Option(
            help="Of a scenario: its task tree, by its name in the library or as a file; without "
            "it, looked for in the library, beside the scenario and in the folder above."
        ),
    ] = None,
) -> None:
    """Check a task, scene, scenario or delivery file, and name every mistake with its line.

    Also what the robot of a world cannot do: parts that it cannot grasp or tell apart, that it
    cannot reach, that have no room. The exit code is 1 if there are any mistakes.
    """
    from mend.server.cli.mistakes import CHECKERS, in_worlds, scenario_mistakes
    from mend.server.cli.task_files import read_text
    from mend.server.scene_checks import load_world_checks

    with told_plainly():
        kind = kind_of_file(read_text(file))
        worlds = load_world_checks()
        asked = worlds if world is None else worlds.only(world)
        if tree is not None and kind != "scenario":
            raise CommandLineError(f"--tree is for scenarios, but '{file}' is a {kind} file")
        checked = (
            CHECKERS[kind](file, asked) if tree is None else scenario_mistakes(file, asked, tree)
        )
    if checked.mistakes:
        raise CommandLineError("\n".join(checked.mistakes), NOT_FINISHED)
    where = f" {in_worlds(checked.worlds)}" if checked.worlds else ""
    typer.echo(f"{file}: a {kind} file without mistakes{where}")


def kind_of_file(text: str) -> str:
    """Tell the kinds of file apart, even where they are full of mistakes."""
    keys, tree_by_name = _top_level(text)
    if keys & SCENE_KEYS:
        return "scene"
    if keys & DELIVERY_KEYS:
        return "delivery"
    return "scenario" if keys & SCENARIO_KEYS or tree_by_name else "task"


def _top_level(text: str) -> tuple[set[str], bool]:
    """The top-level keys, and whether `tree` is one that names a tree."""
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        return set(TOP_LEVEL_KEY.findall(text)), TREE_BY_NAME.search(text) is not None
    if not isinstance(data, dict):
        return set(), False
    return set(data), isinstance(data.get("tree"), str)
