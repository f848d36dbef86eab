"""Where the search begins: a schedule as hints to the model's variables."""

from itertools import pairwise

from mend.fleet.scheduling.exact.model import SCALE, ExactModel, RobotVariables
from mend.fleet.scheduling.exact.nodes import NodeKind
from mend.fleet.scheduling.schedule import Action, RobotSchedule, Schedule, Stop


def hint_from(exact: ExactModel, schedule: Schedule) -> None:
    """Hint a schedule's routes, cargo and times.

    A schedule in which a robot visits a transfer place twice does not fit the model and hints
    only what does.
    """
    for robot, planned in zip(exact.robots, schedule.robots, strict=True):
        _hint_robot(exact, robot, planned)


def _hint_robot(exact: ExactModel, robot: RobotVariables, planned: RobotSchedule) -> None:
    visits = _visits(robot, planned)
    route = [0, *(at for at, _ in visits), 1]
    arcs = set(pairwise(route))
    for arc, chosen in robot.arcs.items():
        exact.model.add_hint(chosen, arc in arcs)
    seen: set[int] = set()
    for at, stops in visits:
        if at in seen:
            continue
        seen.add(at)
        exact.model.add_hint(robot.begin[at], round(stops[0].begin_s * SCALE))
        for stop in stops:
            exchanges = {Action.GIVE: robot.gives, Action.TAKE: robot.takes}
            if stop.task.action in exchanges:
                exact.model.add_hint(exchanges[stop.task.action][at, stop.task.item], True)
    for at, visited in robot.visited.items():
        if not isinstance(visited, bool):
            exact.model.add_hint(visited, at in seen)


def _visits(robot: RobotVariables, planned: RobotSchedule) -> list[tuple[int, list[Stop]]]:
    """The stops by node; those at one transfer place right after each other are one visit."""
    nodes = {
        (node.kind, node.item if node.item is not None else node.place): at
        for at, node in enumerate(robot.nodes)
    }
    kinds = {Action.PICK: NodeKind.PICK, Action.DROP: NodeKind.DROP}
    visits: list[tuple[int, list[Stop]]] = []
    for stop in planned.stops:
        kind = kinds.get(stop.task.action, NodeKind.TRANSFER)
        key = stop.task.place if kind is NodeKind.TRANSFER else stop.task.item
        at = nodes[kind, key]
        if visits and visits[-1][0] == at:
            visits[-1][1].append(stop)
        else:
            visits.append((at, [stop]))
    return visits
