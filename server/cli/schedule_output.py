"""What `mend schedule` prints: progress, the routes as a table, or everything as JSON."""

import json
from dataclasses import dataclass, field
from typing import Any

from rich.console import Console
from rich.status import Status as Spinner

from mend.fleet.scheduling.objective import route_distance_m
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action, Schedule, Stop
from mend.fleet.scheduling.solution import Progress, Solution

BOUND_EVERY_S = 1.0
"""How often a better bound alone is worth a line."""

PREPARING = "getting the search ready; its first use compiles it, which takes up to a minute"

EXPLAINING = "no schedule was found; looking for what is in the way"

HEADINGS = ("robot", "arrival", "begin", "departure", "place", "what")

VERBS = {
    Action.PICK: "picks up",
    Action.DROP: "delivers",
    Action.GIVE: "gives",
    Action.TAKE: "takes",
}
PREPOSITIONS = {Action.GIVE: "to", Action.TAKE: "from"}


@dataclass(frozen=True, slots=True)
class Measure:
    """A problem's own objective: the weighted cost, or distance after the number of robots."""

    problem: Problem
    robots_first: bool

    def objective(self, solution: Solution) -> float | None:
        """What is to be small in the schedule that was found."""
        if solution.cost is None:
            return None
        return solution.cost.distance_m if self.robots_first else solution.cost.total

    def bound(self, solution: Solution) -> float | None:
        """What no schedule can beat: with robots first, none with as few robots."""
        if solution.bound is None:
            return None
        objective = self.objective(solution)
        bound = solution.bound
        if self.robots_first and solution.cost is not None:
            bound -= self.problem.weights.robots * solution.cost.robots
        if bound < 0:
            return None
        return bound if objective is None else min(bound, objective)

    def words(self, total: float) -> str:
        """A cost for a person."""
        if not self.robots_first:
            return f"{total:.2f}"
        robots, distance_m = divmod(total, self.problem.weights.robots)
        return f"{robots:.0f} robots, {distance_m:.2f} m"


@dataclass
class ProgressOutput:
    """Tells of incumbents and bounds: a line that changes in a terminal, else a line each."""

    measure: Measure
    console: Console
    _spinner: Spinner | None = None
    _told: float | None = field(default=None, init=False)
    _told_s: float = field(default=0.0, init=False)

    def __enter__(self) -> "ProgressOutput":
        if self.console.is_terminal:
            self._spinner = self.console.status("searching")
            self._spinner.start()
        return self

    def __exit__(self, *_: object) -> None:
        if self._spinner is not None:
            self._spinner.stop()

    def say(self, words: str) -> None:
        """Tell what is going on."""
        if self._spinner is not None:
            self._spinner.update(words)
        else:
            self.console.print(words)

    def take(self, progress: Progress) -> None:
        """Tell, if there is anything new."""
        incumbent = "none yet" if progress.incumbent is None else self._words(progress.incumbent)
        bound = "none" if progress.bound is None else self._words(progress.bound)
        line = f"{progress.seconds:7.1f} s  best {incumbent}  bound {bound}"
        if self._spinner is not None:
            self._spinner.update(line.strip())
            return
        better = progress.incumbent is not None and progress.incumbent != self._told
        if better or progress.seconds - self._told_s >= BOUND_EVERY_S:
            self._told, self._told_s = progress.incumbent, progress.seconds
            self.console.print(line)

    def _words(self, total: float) -> str:
        return self.measure.words(total)


def summary(measure: Measure, solution: Solution) -> str:
    """The result in one line."""
    if solution.schedule is None or solution.cost is None:
        return f"{solution.status} after {solution.seconds:.1f} s: no schedule was found"
    cost, bound = solution.cost, measure.bound(solution)
    parts = [
        solution.status.value,
        f"objective {measure.objective(solution):.2f}",
        "no bound" if bound is None else f"bound {bound:.2f}",
        f"{cost.robots} robots",
        f"{cost.distance_m:.2f} m",
        f"{solution.schedule.transfers} transfers",
        f"{solution.seconds:.1f} s",
    ]
    return ", ".join(parts)


def table(problem: Problem, schedule: Schedule) -> list[tuple[str, ...]]:
    """A row per stop, and one for each robot's begin and end."""
    rows: list[tuple[str, ...]] = []
    for number, planned in enumerate(schedule.robots):
        if not _drives(problem, schedule, number):
            continue
        robot = problem.robots[number]
        start = problem.places[robot.start]
        rows.append((robot.name, "", "", f"{planned.leaves_s:.1f}", start, "starts"))
        rows.extend(_row(problem, robot.name, stop) for stop in planned.stops)
        end = "" if robot.end is None else problem.places[robot.end]
        rows.append((robot.name, f"{planned.ends_s:.1f}", "", "", end, "ends"))
    return rows


def _row(problem: Problem, robot: str, stop: Stop) -> tuple[str, ...]:
    task = stop.task
    what = f"{VERBS[task.action]} {problem.items[task.item].name}"
    if task.partner is not None:
        what += f" {PREPOSITIONS[task.action]} {problem.robots[task.partner].name}"
    times = (f"{each:.1f}" for each in (stop.arrival_s, stop.begin_s, stop.departure_s))
    return (robot, *times, problem.places[task.place], what)


def as_json(measure: Measure, solution: Solution) -> str:
    """The result for programs; null where there is no schedule."""
    cost, schedule = solution.cost, solution.schedule
    result = {
        "status": solution.status.value,
        "objective": measure.objective(solution),
        "bound": measure.bound(solution),
        "vehicles": None if cost is None else cost.robots,
        "distance": None if cost is None else cost.distance_m,
        "transfers": None if schedule is None else schedule.transfers,
        "seconds": round(solution.seconds, 3),
        "routes": None if schedule is None else _routes(measure.problem, schedule),
    }
    return json.dumps(result)


def _drives(problem: Problem, schedule: Schedule, number: int) -> bool:
    return schedule.robots[number].used or route_distance_m(problem, number, schedule) > 0


def _routes(problem: Problem, schedule: Schedule) -> list[dict[str, Any]]:
    return [
        {
            "robot": problem.robots[number].name,
            "leaves": planned.leaves_s,
            "ends": planned.ends_s,
            "distance": route_distance_m(problem, number, schedule),
            "stops": [_stop(problem, stop) for stop in planned.stops],
        }
        for number, planned in enumerate(schedule.robots)
        if _drives(problem, schedule, number)
    ]


def _stop(problem: Problem, stop: Stop) -> dict[str, Any]:
    partner = stop.task.partner
    return {
        "place": problem.places[stop.task.place],
        "action": stop.task.action.value,
        "item": problem.items[stop.task.item].name,
        "partner": None if partner is None else problem.robots[partner].name,
        "arrival": stop.arrival_s,
        "begin": stop.begin_s,
        "departure": stop.departure_s,
    }
