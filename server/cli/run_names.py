"""How people name runs of a service, and nodes of their trees, on the command line."""

from mend.server.cli.failures import CommandLineError
from mend.server.client import MendClient
from mend.server.runtime.views import NodeView, RunStatus, RunSummary

LISTED = 5
MOST_RUNS = 1000
GO_ON = (RunStatus.RUNNING, RunStatus.PAUSED)


async def find_run(client: MendClient, said: str | None) -> RunSummary:
    """The run of an id, of enough of its beginning, or of a tree; the only one if nothing is said.

    Only runs that go on are meant. Raises `CommandLineError`, and the client's errors.
    """
    # However many have ended since they began.
    runs = await client.runs(status=GO_ON, limit=MOST_RUNS)
    wanted = (said or "").lower()
    # The name of a tree may be the beginning of another run's id.
    found = [each for each in runs if str(each.id).startswith(wanted) or each.tree == said]
    if len(found) == 1:
        return found[0]
    listed = ", ".join(f"{each.id} ({each.tree})" for each in (found or runs)[:LISTED])
    if not runs:
        raise CommandLineError("no run goes on at this service: start one with `mend run --url`")
    if said is None:
        raise CommandLineError(f"say with --run which of the runs that go on is meant: {listed}")
    if found:
        raise CommandLineError(f"'{said}' may be any of the runs {listed}: say more of its id")
    raise CommandLineError(f"no run '{said}' goes on; these do: {listed}")


async def find_node(client: MendClient, run: RunSummary, said: str) -> str:
    """The path of a node, by that or by a name that no other node of the run has.

    Raises `CommandLineError`, and the client's errors.
    """
    if said.startswith("/"):
        return said
    nodes = (await client.run(run.id)).nodes
    found = [each for each in nodes if each.name == said]
    if len(found) == 1:
        return found[0].node
    if found:
        raise CommandLineError(
            f"'{said}' may be any of the nodes {_listed(found)}: say the path of one"
        )
    leaves = [each for each in nodes if each.kind == "behavior"]
    raise CommandLineError(
        f"the run's tree has no node '{said}'; leaves of it are {_listed(leaves)}"
    )


def _listed(nodes: list[NodeView]) -> str:
    named = [f"{each.node} ({each.name})" for each in nodes[:LISTED]]
    return ", ".join(named) + (f" and {len(nodes) - LISTED} more" if len(nodes) > LISTED else "")
