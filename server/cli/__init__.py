"""The command line: `mend`, one module per command."""

import os
import sys
from importlib.metadata import version
from typing import Annotated

import typer

from mend.garbage import look_for_garbage_seldom
from mend.server.cli.failures import CommandLineError
from mend.server.cli.lazy_commands import LazyGroup, add_commands

PIPE_CLOSED = 141
"""Exit code when whoever read the output went away (128 and the number of SIGPIPE)."""

app = typer.Typer(
    name="mend",
    cls=LazyGroup,
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


add_commands(app)


def main() -> None:
    """The entry point: every failure ends in sentences on stderr, never in a traceback."""
    look_for_garbage_seldom()
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
