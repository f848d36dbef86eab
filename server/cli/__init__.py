"""The command line: `mend`, one module per command."""

import os
import sys
from collections.abc import Callable
from importlib.metadata import version
from typing import Annotated

import typer

from mend.server.cli.access import access_app
from mend.server.cli.check import check
from mend.server.cli.failures import CommandLineError
from mend.server.cli.journal import journal_app
from mend.server.cli.localize import localize
from mend.server.cli.map import maps_app
from mend.server.cli.replay import replay
from mend.server.cli.run import run
from mend.server.cli.scenarios import scenarios
from mend.server.cli.scene import scene_app
from mend.server.cli.scenes import scenes
from mend.server.cli.schedule import schedule
from mend.server.cli.schema import schema
from mend.server.cli.serve import serve
from mend.server.cli.talk import talk
from mend.server.cli.train_colors import train_colors
from mend.server.cli.trees import trees

PIPE_CLOSED = 141
"""Exit code when whoever read the output went away (128 and the number of SIGPIPE)."""

app = typer.Typer(
    name="mend",
    help="Run robots through task trees, and ask a person for help when they fail.",
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"mend {version('mend-robots')}")
        raise typer.Exit


@app.callback()
def common_options(
    _version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Say the version."),
    ] = False,
) -> None:
    """Run robots through task trees, and ask a person for help when they fail."""


COMMANDS: dict[str, tuple[Callable[..., None], str]] = {
    "run": (run, "Run a task tree and print what happens."),
    "serve": (serve, "Serve the API, the helper console, the robots."),
    "talk": (talk, "Answer a robot by voice, from a terminal."),
    "check": (check, "Find the mistakes of a file."),
    "trees": (trees, "List the task trees that there are."),
    "scenes": (scenes, "List the scenes that there are."),
    "scenarios": (scenarios, "List the scenarios that there are."),
    "schema": (schema, "Print a schema as JSON."),
    "schedule": (schedule, "Plan deliveries for several robots."),
    "localize": (localize, "Follow a robot through a recorded drive."),
    "replay": (replay, "Tell a run again from its journal."),
    "train-colors": (train_colors, "Learn the colours of objects."),
}

for name, (command, summary) in COMMANDS.items():
    app.command(name, short_help=summary)(command)
app.add_typer(access_app)
app.add_typer(maps_app)
app.add_typer(journal_app)
app.add_typer(scene_app)


def main() -> None:
    """The entry point: every failure ends in sentences on stderr, never in a traceback."""
    try:
        app(prog_name="mend")
    except CommandLineError as failure:
        for sentence in str(failure).splitlines():
            print(f"mend: {sentence}", file=sys.stderr)  # noqa: T201 - this is what it is for
        sys.exit(failure.exit_code)
    except BrokenPipeError:
        # What is still buffered has nobody to read it, and must not fail again at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(PIPE_CLOSED)
