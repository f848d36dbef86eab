"""What `mend run` asks of the service of its own, from the options."""

import secrets
from json import loads
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, SecretStr, ValidationError
from pydantic_core import ErrorDetails

from mend.documents.validation import what_is_right
from mend.server.cli.answers import Answers, read_answers
from mend.server.cli.failures import CommandLineError
from mend.server.cli.journals import new_run_journal
from mend.server.cli.run_files import RunFiles
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.steering_views import SetAutonomy, SteerNode
from mend.server.settings import Settings, load_settings
from mend.server.sites.requests import FleetOptions, SiteRequest
from mend.tasks.scenario import Scenario

T = TypeVar("T", bound=BaseModel)

ARGUMENTS: dict[type[BaseModel], tuple[str, ...]] = {
    RunRequest: ("tree",),
    SiteRequest: ("scene",),
    SteerNode: ("node",),
    SetAutonomy: (),
    FleetOptions: (),
}
"""What is no option of its command."""


def settings_of_its_own(
    journal: Path | None, files: RunFiles, *, takes_robots: bool = False
) -> Settings:
    """A service that only this process can use: loopback, a free port, a token of its own.

    With `takes_robots` robots come in as they do with `mend serve`, by the same settings.
    """
    own = load_settings(log_level="warning") if takes_robots else closed_settings()
    chosen = journal or new_run_journal(own, files.tree)
    return own.model_copy(update={"journal": chosen})


def closed_settings() -> Settings:
    """Of a service that only this process can use."""
    closed: dict[str, Any] = {
        "host": "127.0.0.1",
        "port": 0,
        "token": SecretStr(secrets.token_urlsafe(32)),
        # Nobody is there to hear a prompt, or to answer one by voice.
        "speech_voice": "none",
        "speech_recognition": False,
    }
    return load_settings(log_level="warning", **closed)


def answers_given(text: str | None, scenario: Scenario | None) -> Answers | None:
    """The scripted answers of the command line, else of the scenario, else None."""
    if text is not None:
        return read_answers(text)
    return list(scenario.answers) or None if scenario is not None else None


def read_speed(text: str) -> Any:
    if text == "max":
        return text
    try:
        return float(text)
    except ValueError:
        raise CommandLineError(f"--speed is '{text}'; it has to be a number or max") from None


def read_robots(given: list[str]) -> list[str] | dict[str, str]:
    """Robots by name, or by where each stands in the scene (PLACE=NAME)."""
    places = [each.partition("=") for each in given]
    if not any(equals for _, equals, _ in places):
        return given
    robots: dict[str, str] = {}
    for each, (place, equals, name) in zip(given, places, strict=True):
        if not (place and equals and name):
            raise CommandLineError(
                f"--robot is '{each}'; where one robot is PLACE=NAME all have to be"
            )
        if place in robots:
            raise CommandLineError(f"--robot '{place}' is given twice")
        robots[place] = name
    return robots


def read_options(given: list[str]) -> dict[str, Any]:
    options: dict[str, Any] = {}
    for each in given:
        name, equals, text = each.partition("=")
        if not (name and equals):
            raise CommandLineError(f"--option is '{each}'; it has to be NAME=VALUE")
        if name in options:
            raise CommandLineError(f"--option '{name}' is given twice")
        options[name] = _read_value(text)
    return options


def _read_value(text: str) -> Any:
    """A number, true or false; anything else is text."""
    try:
        value = loads(text)
    except ValueError:
        return text
    return value if isinstance(value, (bool, int, float)) else text


def checked_request(kind: type[T], **fields: Any) -> T:
    """A request of these fields. Raises `CommandLineError`: which option is wrong, and why."""
    try:
        return kind(**fields)
    except ValidationError as error:
        wrong: dict[str, list[ErrorDetails]] = {}
        for each in error.errors():
            wrong.setdefault(str(each["loc"][0]), []).append(each)
        raise CommandLineError(
            "\n".join(
                f"{_option(name, kind)} {what_is_right(mistakes, None)}"
                for name, mistakes in wrong.items()
            )
        ) from error


def _option(name: str, kind: type[BaseModel]) -> str:
    """How a field is called on the command line."""
    return name.upper() if name in ARGUMENTS[kind] else f"--{name.replace('_', '-')}"
