"""`mend access`: who may do what, and who did what."""

import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mend.server.access.roles import Role
from mend.server.access.tokens import LONGEST_DAYS
from mend.server.cli.failures import NOT_FINISHED, CommandLineError, told_plainly
from mend.server.cli.rows import print_rows

if TYPE_CHECKING:
    from mend.server.access.changes import PrincipalsEditor
    from mend.server.settings import Settings

MOST_DAMAGE_TOLD = 20

app = typer.Typer(
    name="access",
    help="Say who may do what, enrol robots, and see who did what.",
    short_help="Say who may do what, and see who did what.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

Name = Annotated[str, typer.Argument(metavar="NAME", help="The principal's name.")]
Expires = Annotated[
    float | None,
    typer.Option("--expires", metavar="DAYS", min=0.001, max=LONGEST_DAYS, help="For how long."),
]
Config = Annotated[Path | None, typer.Option(help="The service's settings in a TOML file.")]


class PersonsRole(StrEnum):
    """The roles that a person may have."""

    VIEWER = "viewer"
    HELPER = "helper"
    OPERATOR = "operator"
    ADMIN = "admin"


@app.command()
def add(
    name: Name,
    role: Annotated[PersonsRole, typer.Option(help="What they may do; each more than the last.")],
    expires: Expires = None,
    config: Config = None,
) -> None:
    """Add a principal and print its token, which is kept nowhere else."""
    with told_plainly():
        settings = _settings(config)
        token = _editor(settings).add(name, Role(role), datetime.now(UTC), expires)
        typer.echo(token)
        _warn_without_admin(settings)


@app.command("list")
def list_principals(config: Config = None) -> None:
    """List the principals and the robots that have a credential of their own."""
    from mend.server.access.principals_file import read_principals

    with told_plainly():
        principals = read_principals(_settings(config).principals_path)
    now = datetime.now(UTC)
    print_rows(
        [
            (
                each.name,
                str(each.role),
                f"{each.added:%Y-%m-%d %H:%M}",
                "" if each.expires is None else f"{each.expires:%Y-%m-%d %H:%M}",
                "" if each.valid(now) else "expired",
            )
            for each in principals.principals
        ],
        ("name", "role", "added", "expires", ""),
    )


@app.command()
def rotate(name: Name, expires: Expires = None, config: Config = None) -> None:
    """Give a principal a new token and print it; the old one and its sessions end."""
    with told_plainly():
        typer.echo(_editor(_settings(config)).rotate(name, datetime.now(UTC), expires))


@app.command()
def revoke(name: Name, config: Config = None) -> None:
    """End a principal: its token, its sessions and its connections."""
    with told_plainly():
        _editor(_settings(config)).revoke(name, datetime.now(UTC))


@app.command()
def enrol(
    robot: Annotated[str, typer.Argument(metavar="ROBOT", help="The robot's name.")],
    minutes: Annotated[float, typer.Option(min=0.1, max=10_080, help="How long it is good.")] = 15,
    config: Config = None,
) -> None:
    """Print a code with which a robot fetches its own credential, once."""
    with told_plainly():
        settings = _settings(config)
        typer.echo(_editor(settings).open_enrolment(robot, datetime.now(UTC), minutes))
        _warn_without_admin(settings)


@app.command()
def audit(
    journal: Annotated[Path | None, typer.Option(help="The journal's file.")] = None,
    who: Annotated[str | None, typer.Option(help="Only what this principal did.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object per line.")] = False,
    config: Config = None,
) -> None:
    """List what people did: when, who, from where, what. The service may be running.

    Where the journal is not what was committed the deeds concerned are marked as DAMAGED, and the
    exit code is 1.
    """
    from mend.server.access.deeds import audit_of

    with told_plainly():
        audit = audit_of(journal or _settings(config).journal_path)
    found = [each for each in audit.deeds if who in (None, each.who)]
    if as_json:
        for each in found:
            sys.stdout.write(each.model_dump_json() + "\n")
    else:
        rows: list[tuple[str, ...]] = [
            (
                "" if each.when is None else f"{each.when:%Y-%m-%d %H:%M:%S}",
                each.who or "",
                str(each.role or ""),
                each.address or "",
                each.what if each.damaged is None else f"DAMAGED: {each.what}",
            )
            for each in found
        ]
        print_rows(rows, ("when (UTC)", "who", "role", "from", "what"))
    sys.stdout.flush()
    if audit.damage:
        marked = sum(each.damaged is not None for each in found)
        raise CommandLineError(_damaged(audit.damage, marked), NOT_FINISHED)


def _damaged(damage: Sequence[str], marked: int) -> str:
    told = list(damage[:MOST_DAMAGE_TOLD])
    if len(damage) > len(told):
        told.append(f"and {len(damage) - len(told)} more places: 'mend journal check' tells all")
    first = (
        "the journal is not what was committed: deeds may be missing, and of those that are listed "
        f"{marked} may not be true ('damaged')"
    )
    return "\n".join([first, *told])


def _settings(config: Path | None) -> "Settings":
    from mend.server.settings import load_settings

    return load_settings(config)


def _editor(settings: "Settings") -> "PrincipalsEditor":
    from mend.server.access.changes import PrincipalsEditor
    from mend.server.cli.local_user import local_user

    return PrincipalsEditor(settings.principals_path, by=local_user())


def _warn_without_admin(settings: "Settings") -> None:
    """Once there are principals a service asks everybody for a token; somebody should have one."""
    from mend.server.access.principals_file import read_principals

    if settings.token is not None:
        return
    principals = read_principals(settings.principals_path).principals
    if not any(each.role is Role.ADMIN for each in principals):
        typer.echo(
            "From now on the service asks everybody for a token, and nobody is an admin yet: "
            "'mend access add NAME --role admin', or set MEND_TOKEN.",
            err=True,
        )
