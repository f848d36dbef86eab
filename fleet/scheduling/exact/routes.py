"""From a solution of the model to routes."""

from ortools.sat.python import cp_model

from mend.fleet.scheduling.exact.model import ExactModel, RobotVariables
from mend.fleet.scheduling.exact.nodes import NodeKind
from mend.fleet.scheduling.schedule import Action, Route, Task


def routes_in(exact: ExactModel, solver: cp_model.CpSolver) -> tuple[Route, ...]:
    """What every robot does in the solver's solution, in order."""
    return tuple(_route(exact, solver, robot) for robot in exact.robots)


def _route(exact: ExactModel, solver: cp_model.CpSolver, robot: RobotVariables) -> Route:
    following = {i: j for (i, j), chosen in robot.arcs.items() if solver.value(chosen)}
    tasks: list[Task] = []
    at = following[0]
    while at != 1:
        node = robot.nodes[at]
        assert node.place is not None, "only an end may be anywhere"
        if node.kind is NodeKind.TRANSFER:
            tasks.extend(_exchanges(exact, solver, robot, at, node.place))
        else:
            assert node.item is not None
            action = Action.PICK if node.kind is NodeKind.PICK else Action.DROP
            tasks.append(Task(node.place, action, node.item))
        at = following[at]
    return tuple(tasks)


def _exchanges(
    exact: ExactModel, solver: cp_model.CpSolver, robot: RobotVariables, at: int, place: int
) -> list[Task]:
    """The gives and takes of one robot at one place, in the order of the model's times."""
    timed: list[tuple[int, int, Task]] = []
    for item in range(len(exact.problem.items)):
        for chosen, action in ((robot.gives, Action.GIVE), (robot.takes, Action.TAKE)):
            if not solver.boolean_value(chosen[at, item]):
                continue
            begin = robot.exchange_begin.get((at, action, item))
            # Where giving takes no time, all is given on arrival and taken just before leaving.
            default = 1 if action is Action.TAKE else 0
            time = default if begin is None else solver.value(begin)
            partner = _partner(exact, solver, at, item, action)
            timed.append((time, default, Task(place, action, item, partner)))
    return [task for _, _, task in sorted(timed, key=lambda each: each[:2])]


def _partner(
    exact: ExactModel, solver: cp_model.CpSolver, at: int, item: int, action: Action
) -> int:
    """Who takes what is given here, or gave what is taken."""
    for number, other in enumerate(exact.robots):
        chosen = other.takes if action is Action.GIVE else other.gives
        if solver.boolean_value(chosen[at, item]):
            return number
    raise AssertionError("the model gives nothing that nobody takes")
