"""What it saves that an item changes robots: the plan as it is, beside one in which it does not.

That other plan is made to compare: the item is sold again to one robot alone, and what robots do
for all others stays in its order.
"""

from dataclasses import dataclass

from mend.fleet.scheduling.auction import sell
from mend.fleet.scheduling.objective import cost
from mend.fleet.scheduling.partial_routes import items_in, part_schedule, without_items
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.replanning.residual_problem import ResidualProblem
from mend.fleet.scheduling.schedule import Action, Route, Schedule


@dataclass(frozen=True, slots=True)
class TransferSaving:
    """So much sooner the item is delivered, and so much less far all robots drive.

    Both are None where one robot alone could not bring it at all.
    """

    sooner_s: float | None = None
    less_m: float | None = None


def transfer_saving(left: ResidualProblem, item: int) -> TransferSaving:
    """Of an item of the problem that is left. Raises `ValueError` where the plan does not hold."""
    with_it = part_schedule(left.problem, left.routes)
    if with_it is None:
        raise ValueError("the plan does not hold, so that it cannot be compared")
    alone = _alone(left, item)
    without = None if alone is None else part_schedule(left.problem, alone)
    if without is None:
        return TransferSaving()
    number = items_in(left.routes).index(item)
    return TransferSaving(
        sooner_s=_delivered_s(without, number) - _delivered_s(with_it, number),
        less_m=cost(*without).distance_m - cost(*with_it).distance_m,
    )


def _alone(left: ResidualProblem, item: int) -> tuple[Route, ...] | None:
    """The routes with one robot alone for an item; None where there are none."""
    routes = list(without_items(left.routes, {item}))
    held, begun = list(left.held), dict[int, int]()
    for robot, route in enumerate(left.routes):
        if not (held[robot] and route[0].item == item):
            continue
        if route[0].action is Action.PICK:
            # Who is on its way to fetch it does so in any case.
            routes[robot], begun[item] = (route[0], *routes[robot]), robot
        else:
            held[robot] = 0
    sale = sell(left.problem, routes, (item,), held=held, begun=begun, transfers=False)
    return None if sale.unsold else sale.routes


def _delivered_s(plan: tuple[Problem, Schedule], item: int) -> float:
    return next(
        stop.departure_s
        for robot in plan[1].robots
        for stop in robot.stops
        if stop.task.item == item and stop.task.action is Action.DROP
    )
