"""The commands by name: a command's module is imported when it is called, not to list it."""

from importlib import import_module
from typing import Any

import typer
from typer.core import TyperGroup

from mend.server.cli.failures import CommandLineError
from mend.tasks.plugins import called_of

SUMMARIES = {
    "run": "Run a task tree and print what happens.",
    "serve": "Serve the API, the helper console, the robots.",
    "talk": "Answer a robot by voice, from a terminal.",
    "check": "Find the mistakes of a file.",
    "trees": "List the task trees that there are.",
    "scenes": "List the scenes that there are.",
    "scenarios": "List the scenarios that there are.",
    "schema": "Print a schema as JSON.",
    "schedule": "Plan deliveries for several robots.",
    "localize": "Follow a robot through a recorded drive.",
    "replay": "Tell a run again from its journal.",
    "export": "Write a run as a file for other programs.",
    "report": "Report what a building's robots did.",
    "train-colors": "Learn the colours of objects.",
    "access": "Say who may do what, and see who did what.",
    "building": "Import, make up and draw buildings, and run robots there.",
    "map": "Build, extract and clean up vector maps.",
    "journal": "Check, prune, back up and restore a journal.",
    "scene": "Make up scenes.",
    "steer": "Steer a run of a service that is there.",
    "model": "List, give and delete models of robots.",
    "request": "Ask a building's robots for something.",
    "site": "Open, list, show and close worlds that stay.",
}
"""Each `some-name` is the group `app` of its module `some_name`, or its function `some_name`."""


EXTRA_OF = {
    "building": "scheduling",
    "check": "scheduling",
    "localize": "localization",
    "map": "localization",
    "schedule": "scheduling",
    "train-colors": "tabletop",
}
"""Which of the distribution's extras a command needs beyond the service itself, if any."""


class LazyGroup(TyperGroup):
    """Lists its commands by their summaries alone, and imports the one that is called."""

    def invoke(self, ctx: Any) -> Any:
        """Raises `CommandLineError` for what is not installed."""
        try:
            return super().invoke(ctx)
        except ModuleNotFoundError as error:
            extra, called = EXTRA_OF.get(ctx.invoked_subcommand), called_of(error)
            if extra is None or called is None:
                raise
            command = f"'mend {ctx.invoked_subcommand}'"
            raise CommandLineError(
                f"{command} needs {called}: install Mend as 'mend-robots[{extra}]'"
            ) from error

    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[str | None, Any, list[str]]:
        name, listed, rest = super().resolve_command(ctx, args)
        return name, None if listed is None else _imported(listed.name or ""), rest


def add_commands(app: typer.Typer) -> None:
    """Have an app, whose class is `LazyGroup`, list every command."""
    for name, summary in SUMMARIES.items():
        app.command(name, short_help=summary)(_not_imported)


def _not_imported() -> None:
    raise NotImplementedError


def _imported(name: str) -> Any:
    attribute = name.replace("-", "_")
    module = import_module(f"mend.server.cli.{attribute}")
    alone = typer.Typer(rich_markup_mode=None)
    if hasattr(module, "app"):
        alone.add_typer(module.app, name=name)
    else:
        alone.command(name)(getattr(module, attribute))
    return typer.main.get_group(alone).commands[name]
