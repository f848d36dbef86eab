"""`mend request`: what people want of a building's robots, at a service that is there."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated
from uuid import UUID

import typer

from mend.server.cli.asked_service import AskedService
from mend.server.cli.failures import CommandLineError
from mend.server.cli.rows import print_rows
from mend.server.cli.shared_options import with_shared_options

if TYPE_CHECKING:
    from mend.server.client import MendClient
    from mend.server.fleets.views import RequestView

app = typer.Typer(
    name="request",
    help="Ask the robots of a building for something, and follow it (docs/requests.md).",
    short_help="Ask a building's robots for something.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

AtSite = Annotated[
    str | None,
    typer.Option("--site", metavar="SITE", help="Whose robots, where several take requests."),
]


@app.command()
@with_shared_options
def make(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A request file.")],
    site: AtSite = None,
    *,
    service: AskedService,
) -> None:
    """Make the requests of a file, and print when each is expected to be done."""
    from mend.fleet.request_file import read_request_file

    document = read_request_file(file)
    if document.happenings or document.asked_s:
        raise CommandLineError(
            f"{file}: 'asked_s' and 'happenings' are for `mend building run`: here people ask"
        )
    requests = document.requests

    async def make_all(client: "MendClient") -> list["RequestView"]:
        at = await _site(client, site)
        return [await client.make_request(each, at) for each in requests]

    _print(service.asked(make_all))


@app.command("list")
@with_shared_options
def list_requests(site: AtSite = None, *, service: AskedService) -> None:
    """List the requests that are open, and the last ones that are over."""

    async def listed(client: "MendClient") -> list["RequestView"]:
        return await client.requests(await _site(client, site))

    _print(service.asked(listed))


@app.command()
@with_shared_options
def cancel(
    name: Annotated[str, typer.Argument(metavar="NAME", help="The request's name.")],
    site: AtSite = None,
    *,
    service: AskedService,
) -> None:
    """Want something no more; what is fetched goes back to where it came from."""

    async def cancel_it(client: "MendClient") -> str:
        await client.cancel_request(name, await _site(client, site))
        return f"'{name}' is no longer wanted"

    typer.echo(service.asked(cancel_it))


async def _site(client: "MendClient", said: str | None) -> UUID | None:
    from mend.server.cli.site_names import find_site

    return None if said is None else (await find_site(client, said)).id


def _print(requests: list["RequestView"]) -> None:
    rows: list[tuple[str, ...]] = [
        (
            each.name,
            each.what["kind"],
            str(each.status),
            "" if each.expected is None else f"{each.expected.done_s:.0f}",
            "" if each.expected is None else each.expected.robot,
            each.reason or "",
        )
        for each in requests
    ]
    print_rows(rows, ("request", "kind", "status", "done (s)", "robot", "why"))
