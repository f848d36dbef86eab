"""Li and Lim's pickup and delivery instances with time windows."""

from math import inf

from mend.fleet.scheduling.instances.numbers import InstanceError, rows
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Weights, Window
from mend.fleet.scheduling.travel import Travel

ROBOT_WEIGHT = 1e6
"""Vehicles count first, then distance; no instance's distance comes near it."""

COLUMNS = 9

MOST_VEHICLES = 1000
"""As many as a delivery file may have robots."""


def read_li_lim(text: str, name: str = "li_lim") -> Problem:
    """An instance: the depot is every robot's start and end, its window their shift.

    Raises `InstanceError` with the line of what is wrong.
    """
    lines = rows(text)
    if not lines or len(lines[0][1]) < 2:
        raise InstanceError(1, "the first line must give the number of vehicles and their capacity")
    vehicles, capacity = lines[0][1][:2]
    if not 0 <= vehicles <= MOST_VEHICLES:
        raise InstanceError(1, f"there may be 0 to {MOST_VEHICLES} vehicles, but not {vehicles:g}")
    nodes = [_node(line, row, number) for number, (line, row) in enumerate(lines[1:])]
    if not nodes:
        raise InstanceError(2, "there is no depot")
    depot = nodes[0]
    robots = tuple(
        Robot(f"v{number + 1}", 0, 0, capacity, Window(depot[4], depot[5]))
        for number in range(int(vehicles))
    )
    points = tuple((node[1], node[2]) for node in nodes)
    return Problem(
        name=name,
        places=tuple(str(number) for number in range(len(nodes))),
        travel=Travel.euclidean(points),
        robots=robots,
        items=tuple(_items(nodes)),
        transfers=Transfers(),
        weights=Weights(robots=ROBOT_WEIGHT),
        coordinates=points,
    )


def _node(line: int, row: tuple[float, ...], number: int) -> tuple[float, ...]:
    if len(row) != COLUMNS:
        raise InstanceError(line, f"a node has {COLUMNS} numbers, but here are {len(row)}")
    if row[0] != number:
        raise InstanceError(line, f"node {number} is expected here, not {row[0]:g}")
    return row


def _items(nodes: list[tuple[float, ...]]) -> list[Item]:
    items = []
    for number, node in enumerate(nodes[1:], start=1):
        delivery = int(node[8])
        if delivery == 0:
            continue
        line = number + 2
        if not 0 < delivery < len(nodes) or int(nodes[delivery][7]) != number:
            raise InstanceError(line, f"node {number} and its delivery {delivery} disagree")
        if nodes[delivery][3] != -node[3]:
            raise InstanceError(line, f"the loads of {number} and {delivery} do not match")
        items.append(
            Item(
                name=f"{number}-{delivery}",
                load=node[3],
                pickup=_visit(nodes, number),
                delivery=_visit(nodes, delivery),
                max_on_board_s=inf,
            )
        )
    return items


def _visit(nodes: list[tuple[float, ...]], number: int) -> Visit:
    node = nodes[number]
    return Visit(number, Window(node[4], node[5]), service_s=node[6])
