"""`mend steer`: where a run of a service waits, and what its robots do next."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from mend.server.cli.asked_service import AskedService
from mend.server.cli.local_user import local_user
from mend.server.cli.rows import print_rows
from mend.server.cli.shared_options import with_shared_options
from mend.tasks.autonomy import AutonomyLevel

if TYPE_CHECKING:
    from mend.server.client import MendClient
    from mend.server.runtime.steering_views import NodeSteeringView, SteeringView
    from mend.server.runtime.views import RunSummary
    from mend.tasks.steering_rules import SteeringAct

app = typer.Typer(
    name="steer",
    help="Say where a run waits, what its robots do next, and how much they do without being "
    "asked (docs/steering.md).",
    short_help="Steer a run of a service that is there.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

ACTS = {
    "go-on": "Let a leaf begin that waits, once; a breakpoint stays.",
    "set-breakpoint": "Have robots wait before a leaf, or the first one under a node.",
    "remove-breakpoint": "Have nobody wait there any more.",
    "do-next": "Have a leaf begun before all others.",
    "not-next": "Have robots choose as ever after all.",
    "try-again": "Have a leaf done as if it were new.",
    "leave-out": "Count a leaf as done without its being there.",
    "done-by-hand": "Say that a leaf is done; a robot looks whether it is.",
}

Node = Annotated[
    str, typer.Argument(metavar="NODE", help="Its path, as /0/1, or a name that no other has.")
]


@dataclass(frozen=True, slots=True)
class SteeredRun:
    """Which run of the service."""

    run: Annotated[
        str | None,
        typer.Option(
            metavar="RUN",
            help="Its id, enough of its beginning, or its tree where no other run has it; not "
            "needed where one run alone goes on.",
        ),
    ] = None

    async def found(self, client: "MendClient") -> "RunSummary":
        """Raises `CommandLineError`."""
        from mend.server.cli.run_names import find_run

        return await find_run(client, self.run)


@dataclass(frozen=True, slots=True)
class Saying:
    """Who says something of a run, and why."""

    reason: Annotated[str, typer.Option(help="Why; the journal keeps it.")] = ""
    by: Annotated[
        str | None, typer.Option("--as", metavar="NAME", help="Who says so, unless the token does.")
    ] = None

    @property
    def said_by(self) -> str:
        return self.by or local_user()


def _command(name: str) -> Callable[..., None]:
    @with_shared_options
    def command(node: Node, *, steered: SteeredRun, saying: Saying, service: AskedService) -> None:
        from mend.server.cli.run_names import find_node
        from mend.server.cli.run_request import checked_request
        from mend.server.runtime.steering_views import SteerNode

        async def steer(client: "MendClient") -> "SteeringView":
            run = await steered.found(client)
            path = await find_node(client, run, node)
            act = name.replace("-", "_")
            wish = checked_request(SteerNode, act=act, node=path, reason=saying.reason)
            return await client.steer(run.id, wish, saying.said_by)

        _print(service.asked(steer))

    return command


for act, effect in ACTS.items():
    app.command(act, help=effect)(_command(act))


@app.command()
@with_shared_options
def autonomy(
    level: Annotated[AutonomyLevel, typer.Argument(metavar="off|low|high|full")],
    *,
    steered: SteeredRun,
    saying: Saying,
    service: AskedService,
) -> None:
    """Say how much the robots of a run do without being asked."""
    from mend.server.cli.run_request import checked_request
    from mend.server.runtime.steering_views import SetAutonomy

    async def steer(client: "MendClient") -> "SteeringView":
        run = await steered.found(client)
        wish = checked_request(SetAutonomy, act="set_autonomy", level=level, reason=saying.reason)
        return await client.steer(run.id, wish, saying.said_by)

    _print(service.asked(steer))


@app.command()
@with_shared_options
def show(*, steered: SteeredRun, service: AskedService) -> None:
    """Show how a run is steered: its autonomy, breakpoints, what is next, and what waits."""

    async def steering(client: "MendClient") -> "SteeringView":
        return await client.steering((await steered.found(client)).id)

    _print(service.asked(steering))


@app.command()
@with_shared_options
def offers(node: Node, *, steered: SteeredRun, service: AskedService) -> None:
    """Show what would be taken of a node now, what comes of it, and why the rest would not."""
    from mend.server.cli.run_names import find_node

    async def offered(client: "MendClient") -> "NodeSteeringView":
        run = await steered.found(client)
        return await client.steering_offers(run.id, await find_node(client, run, node))

    view = service.asked(offered)
    rows: list[tuple[str, ...]] = [
        (_spoken(each.act), "taken", each.effect) for each in view.offered
    ]
    rows += [(_spoken(each.act), "refused", each.why) for each in view.refused]
    print_rows(rows, ("act", "now", "what comes of it, or why not"))


def _print(view: "SteeringView") -> None:
    rows: list[tuple[str, ...]] = [("autonomy", str(view.autonomy), "", "", "")]
    rows += [
        ("waits before", each.node, each.name, each.by or "", each.reason) for each in view.waits
    ]
    rows += [
        ("breakpoint", each.node, each.name, each.by, each.reason) for each in view.breakpoints
    ]
    if (following := view.preferred) is not None:
        rows.append(("next", following.node, following.name, following.by, following.reason))
    print_rows(rows, ("what", "node", "name", "by", "why"))


def _spoken(act: "SteeringAct") -> str:
    """An act as its command is called."""
    return act.replace("_", "-")
