"""What a robot can visit: its start and end, every pickup and delivery, every transfer place."""

from dataclasses import dataclass
from enum import Enum, auto
from math import inf

from mend.fleet.scheduling.problem import Problem, Window
from mend.fleet.scheduling.tolerance import CHECK_S


class NodeKind(Enum):
    """What happens at a node."""

    START = auto()
    END = auto()
    PICK = auto()
    DROP = auto()
    TRANSFER = auto()


@dataclass(frozen=True, slots=True)
class Node:
    """A place to visit at most once. `item` for pickups and deliveries.

    `place` is None for an end that may be anywhere: it is reached from everywhere at once.
    """

    kind: NodeKind
    place: int | None
    window: Window
    service_s: float = 0.0
    item: int | None = None


def nodes_of(problem: Problem, robot: int) -> list[Node]:
    """All that this robot could visit; its start is the first node, its end the second."""
    described = problem.robots[robot]
    nodes = [
        Node(NodeKind.START, described.start, described.shift),
        Node(NodeKind.END, described.end, described.shift),
    ]
    for number, item in enumerate(problem.items):
        pickup, delivery = item.pickup, item.delivery
        if item.aboard is None:
            nodes.append(Node(NodeKind.PICK, pickup.place, pickup.window, pickup.service_s, number))
        nodes.append(
            Node(NodeKind.DROP, delivery.place, delivery.window, delivery.service_s, number)
        )
    nodes.extend(Node(NodeKind.TRANSFER, place, Window()) for place in problem.transfers.places)
    return nodes


def travel(problem: Problem, robot: int, origin: Node, destination: Node) -> tuple[float, float]:
    """Distance (metres) and time (seconds) of a robot between two nodes."""
    if destination.place is None:
        return 0.0, 0.0
    assert origin.place is not None, "nobody leaves an end"
    distance_m = float(problem.travel.distance_m[origin.place, destination.place])
    return distance_m, problem.travel_time_s(robot, origin.place, destination.place)


def arcs(problem: Problem, robot: int, nodes: list[Node]) -> list[tuple[int, int]]:
    """The pairs of nodes that a robot can visit one right after the other, by number."""
    return [
        (i, j)
        for i, origin in enumerate(nodes)
        for j, destination in enumerate(nodes)
        if i != j and _follows(problem, robot, origin, destination)
    ]


def _follows(problem: Problem, robot: int, origin: Node, destination: Node) -> bool:
    if origin.kind is NodeKind.END or destination.kind is NodeKind.START:
        return False
    if origin.kind is NodeKind.PICK and destination.kind is NodeKind.END:
        return False
    if origin.kind is NodeKind.START and destination.kind is NodeKind.DROP:
        assert destination.item is not None
        if problem.items[destination.item].aboard != robot:
            return False
    same = origin.item is not None and origin.item == destination.item
    if same and origin.kind is NodeKind.DROP:
        return False
    _, time_s = travel(problem, robot, origin, destination)
    if time_s == inf:
        return False
    shift = problem.robots[robot].shift
    earliest_s = max(origin.window.earliest_s, shift.earliest_s) + origin.service_s + time_s
    return earliest_s <= min(destination.window.latest_s, shift.latest_s) + CHECK_S
