"""`mend site`: simulated worlds that stay, of a service that is there."""

from typing import TYPE_CHECKING, Annotated

import typer

from mend.server.cli.asked_service import AskedService
from mend.server.cli.rows import print_rows
from mend.server.cli.shared_options import with_shared_options

if TYPE_CHECKING:
    from mend.server.client import MendClient
    from mend.server.sites.views import SiteView

app = typer.Typer(
    name="site",
    help="Open, list, show and close simulated worlds that stay (docs/sites.md).",
    short_help="Open, list, show and close worlds that stay.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

Site = Annotated[
    str,
    typer.Argument(
        metavar="SITE", help="Its id, enough of its beginning, or its scene where no other has it."
    ),
]


@app.command("open")
@with_shared_options
def open_site(
    scene: Annotated[
        str, typer.Argument(metavar="SCENE", help="Its name in the service's library, or a file.")
    ],
    world: Annotated[
        str, typer.Option(help="workcell, tabletop or a world of yours.")
    ] = "workcell",
    speed: Annotated[
        str, typer.Option(help="Simulated seconds per second, or max for as fast as possible.")
    ] = "1.0",
    seed: Annotated[int, typer.Option(help="Makes every chance in it repeatable.")] = 0,
    option: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE",
            help="What the world has to choose (docs/worlds.md); may be given several times.",
        ),
    ] = None,
    fleet: Annotated[
        str | None,
        typer.Option(
            metavar="ANSWERS",
            help="Its robots take requests, in a building; who answers them: live helpers, or yes "
            "for somebody who does whatever is asked.",
        ),
    ] = None,
    *,
    service: AskedService,
) -> None:
    """Open a site and print its id; it stays until it is closed, also over restarts."""
    from mend.server.cli.run_request import checked_request, read_options, read_speed
    from mend.server.cli.site_names import scene_at
    from mend.server.sites.requests import SiteRequest

    async def open_it(client: "MendClient") -> str:
        request = checked_request(
            SiteRequest,
            scene=await scene_at(client, scene),
            world=world,
            speed=read_speed(speed),
            seed=seed,
            world_options=read_options(option or []),
            fleet=None if fleet is None else {"answers": fleet},
        )
        return str((await client.open_site(request)).id)

    typer.echo(service.asked(open_it))


@app.command("list")
@with_shared_options
def list_sites(service: AskedService) -> None:
    """List the sites that are open, and how many of their robots no run has."""
    print_rows(
        [
            (
                str(each.id),
                each.scene,
                each.world,
                f"{each.opened:%Y-%m-%d %H:%M}",
                f"{sum(robot.run is None for robot in each.robots)} of {len(each.robots)}",
            )
            for each in service.asked(lambda client: client.sites())
        ],
        ("site", "scene", "world", "opened (UTC)", "free"),
    )


@app.command()
@with_shared_options
def show(site: Site, service: AskedService) -> None:
    """Show one site: its robots, the runs that have them, and where runs have left parts."""
    from mend.server.cli.site_names import find_site

    for line in _described(service.asked(lambda client: find_site(client, site))):
        typer.echo(line)


@app.command()
@with_shared_options
def close(site: Site, service: AskedService) -> None:
    """Close a site for good; no run may be using it."""
    from mend.server.cli.site_names import find_site

    async def close_it(client: "MendClient") -> str:
        found = await find_site(client, site)
        await client.close_site(found.id)
        return f"site {found.id} is closed"

    typer.echo(service.asked(close_it))


def _described(site: "SiteView") -> list[str]:
    speed = site.speed if site.speed == "max" else f"{site.speed:g}"
    lines = [f"site {site.id}: {site.scene} in {site.world} (seed {site.seed}, speed {speed})"]
    for each in site.robots:
        where = "connected" if each.connected else "not connected"
        lines.append(
            f"{each.robot} ({each.stands}): {where}, "
            f"{'free' if each.run is None else f'in run {each.run}'}"
        )
    return [*lines, *(f"{part} is at {place}" for part, place in sorted(site.moved.items()))]
