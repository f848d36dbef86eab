"""The constraints of a schedule by name, and the sentence that says what one demands."""

from collections.abc import Iterable
from enum import StrEnum
from typing import NamedTuple

from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action, Task

WHILE_OPEN = "only while the doors and elevators on its way are open"
"""Of a robot that gets somewhere through doors, or by elevators, that are closed at times."""

_OF_VISITS = {Action.PICK: "begin", Action.DROP: "end"}


class ConstraintKind(StrEnum):
    """What a constraint is about."""

    SHIFT_BEGIN = "shift_begin"
    SHIFT_END = "shift_end"
    DURATION = "duration"
    TRAVEL = "travel"
    OPENING = "opening"
    HOMEWARD = "homeward"
    WINDOW_BEGIN = "window_begin"
    WINDOW_END = "window_end"
    ON_BOARD = "on_board"
    TRANSFER = "transfer"


class Constraint(NamedTuple):
    """One constraint: of a robot, of a task, or between two."""

    kind: ConstraintKind
    robot: int | None = None
    task: Task | None = None


def sentences(problem: Problem, constraints: Iterable[Constraint]) -> str:
    """What the constraints demand, one after the other."""
    return "; ".join(sentence(problem, each) for each in constraints)


def sentence(problem: Problem, constraint: Constraint) -> str:
    """What the constraint demands, for a person."""
    robot = problem.robots[constraint.robot] if constraint.robot is not None else None
    item = problem.items[constraint.task.item] if constraint.task is not None else None
    what = _task_words(problem, constraint.task)
    match constraint.kind:
        case ConstraintKind.SHIFT_BEGIN:
            assert robot is not None
            return f"{robot.name} starts at {robot.shift.earliest_s:g} s"
        case ConstraintKind.SHIFT_END:
            assert robot is not None
            return f"the shift of {robot.name} ends at {robot.shift.latest_s:g} s"
        case ConstraintKind.DURATION:
            assert robot is not None
            return f"{robot.name} may be away for {robot.max_duration_s:g} s"
        case ConstraintKind.TRAVEL:
            assert robot is not None
            return f"{robot.name} has to get there to {what}"
        case ConstraintKind.OPENING:
            assert robot is not None
            where = f"get there to {what}" if constraint.task else "get to its end"
            return f"{robot.name} can {where} {WHILE_OPEN}"
        case ConstraintKind.HOMEWARD:
            assert robot is not None
            return f"{robot.name} has to get to its end"
        case ConstraintKind.WINDOW_BEGIN | ConstraintKind.WINDOW_END:
            assert item is not None
            assert constraint.task is not None
            loading = constraint.task.action.loads
            window = (item.pickup if loading else item.delivery).window
            begins = constraint.kind is ConstraintKind.WINDOW_BEGIN
            if begins:
                return f"nobody can {what} before {window.earliest_s:g} s"
            return f"to {what} must begin by {window.latest_s:g} s"
        case ConstraintKind.ON_BOARD:
            assert item is not None
            return f"{item.name} may be on board for {item.max_on_board_s:g} s"
        case ConstraintKind.TRANSFER:
            assert item is not None
            return f"{item.name} can be taken only after it was given"


def _task_words(problem: Problem, task: Task | None) -> str:
    if task is None:
        return ""
    item = problem.items[task.item]
    action = _OF_VISITS.get(task.action, task.action) if item.is_visit else task.action
    return f"{action} {item.name} at {problem.places[task.place]}"
