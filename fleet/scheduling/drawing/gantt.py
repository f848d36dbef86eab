"""Who does what when: a row per robot, what it has on board below, transfers across."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import floor, log10

from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action, RobotSchedule, Schedule
from mend.fleet.scheduling.tolerance import CHECK_S
from mend.maps.svg import Svg, color, text_width_px

STRIP_PX = 9.0
LANE_PX = 20.0
GAP_PX = 16.0
TICKS = 8


@dataclass(slots=True)
class _Ride:
    """An item on board of a robot; `lane` counts from the robot's strip downwards."""

    item: int
    from_s: float
    until_s: float
    lane: int = 0


@dataclass(frozen=True, slots=True)
class _Axis:
    """Time from left to right."""

    left_px: float
    right_px: float
    last_s: float

    def x(self, time_s: float) -> float:
        return self.left_px + (self.right_px - self.left_px) * time_s / self.last_s


def draw_gantt(
    svg: Svg, problem: Problem, schedule: Schedule, robots: Sequence[int], top: float, width: float
) -> float:
    """Draw the rows of these robots from `top` downwards; returns where the drawing ends."""
    names = [problem.robots[robot].name for robot in robots]
    last_s = max((schedule.robots[robot].ends_s for robot in robots), default=0.0) or 1.0
    left = 16 + max((text_width_px(name) for name in names), default=0.0) + 12
    axis = _Axis(left, width - 24, last_s)
    rides = {robot: _rides(problem, schedule.robots[robot], robot, axis) for robot in robots}
    heights = {
        robot: STRIP_PX + LANE_PX * (1 + max((ride.lane for ride in rides[robot]), default=-1))
        for robot in robots
    }
    bottom = top + 22 + sum(heights.values()) + GAP_PX * len(robots)
    _draw_axis(svg, axis, top, bottom)
    y, tops = top + 22, {}
    for robot in robots:
        tops[robot] = y
        svg.text(16, y + STRIP_PX, problem.robots[robot].name, "name")
        _draw_strip(svg, schedule.robots[robot], axis, y, color(robot))
        for ride in rides[robot]:
            _draw_ride(svg, problem, ride, axis, y)
        y += heights[robot] + GAP_PX
    _draw_transfers(svg, schedule, rides, tops, axis)
    return bottom


def _rides(problem: Problem, planned: RobotSchedule, robot: int, axis: _Axis) -> list[_Ride]:
    """What is on board when, in lanes in which neither bars nor names overlap."""
    loaded_s = {n: planned.leaves_s for n, item in enumerate(problem.items) if item.aboard == robot}
    rides = []
    for stop in planned.stops:
        item = stop.task.item
        if stop.task.action.loads:
            loaded_s[item] = stop.begin_s
        else:
            rides.append(_Ride(item, loaded_s.pop(item), stop.departure_s))
    ends_px: list[float] = []
    for ride in sorted(rides, key=lambda each: (each.from_s, each.until_s)):
        begin, end = _ride_extent(problem, ride, axis)
        ride.lane = next((n for n, free in enumerate(ends_px) if free <= begin), len(ends_px))
        ends_px[ride.lane : ride.lane + 1] = [end + 6]
    return rides


def _label_x(problem: Problem, ride: _Ride, axis: _Axis) -> float:
    """Where a name begins: at its bar, but within the picture."""
    return min(axis.x(ride.from_s), axis.right_px - text_width_px(problem.items[ride.item].name))


def _ride_extent(problem: Problem, ride: _Ride, axis: _Axis) -> tuple[float, float]:
    label = _label_x(problem, ride, axis)
    end = label + text_width_px(problem.items[ride.item].name)
    return min(axis.x(ride.from_s), label), max(axis.x(ride.until_s), end)


def _draw_axis(svg: Svg, axis: _Axis, top: float, bottom: float) -> None:
    step_s = _round_step(axis.last_s / TICKS)
    for tick in range(int(axis.last_s / step_s) + 1):
        x = axis.x(tick * step_s)
        svg.add("line", x1=x, x2=x, y1=top + 8, y2=bottom, class_="grid")
        svg.text(x, top + 2, f"{tick * step_s:g} s", "soft middle")


def _round_step(about: float) -> float:
    power: float = 10.0 ** floor(log10(about))
    return next(power * each for each in (1, 2, 5, 10) if power * each >= about)


def _draw_strip(svg: Svg, planned: RobotSchedule, axis: _Axis, y: float, fill: str) -> None:
    """Driving is a thin line in the robot's colour, waiting a pale bar, work a solid one."""
    begin, end = axis.x(planned.leaves_s), axis.x(planned.ends_s)
    svg.add("rect", x=begin, y=y + 3, width=max(0.0, end - begin), height=3, rx=1.5, fill=fill)
    for stop in planned.stops:
        for from_s, until_s, class_ in (
            (stop.arrival_s, stop.begin_s, "wait"),
            (stop.begin_s, stop.departure_s, "busy"),
        ):
            if until_s > from_s:
                x = axis.x(from_s)
                svg.add("rect", x=x, y=y, width=axis.x(until_s) - x, height=STRIP_PX, class_=class_)
        svg.add("circle", cx=axis.x(stop.begin_s), cy=y + 4.5, r=3.0, class_="busy")


def _bar_y(ride: _Ride, top: float) -> float:
    return top + STRIP_PX + LANE_PX * ride.lane + 15


def _draw_ride(svg: Svg, problem: Problem, ride: _Ride, axis: _Axis, top: float) -> None:
    y, x = _bar_y(ride, top), axis.x(ride.from_s)
    width = max(2.0, axis.x(ride.until_s) - x)
    svg.add("rect", x=x, y=y, width=width, height=5, rx=2.5, fill=color(ride.item))
    svg.text(_label_x(problem, ride, axis), y - 3, problem.items[ride.item].name, "halo")


def _draw_transfers(
    svg: Svg,
    schedule: Schedule,
    rides: dict[int, list[_Ride]],
    tops: dict[int, float],
    axis: _Axis,
) -> None:
    """A dashed line from the end of one ride to the begin of the next."""
    for robot in tops:
        for stop in schedule.robots[robot].stops:
            if stop.task.action is not Action.GIVE or stop.task.partner is None:
                continue
            item, partner = stop.task.item, stop.task.partner
            given = next(
                r for r in rides[robot] if r.item == item and r.until_s == stop.departure_s
            )
            taken = next(
                r for r in rides[partner] if r.item == item and r.from_s >= stop.begin_s - CHECK_S
            )
            ends = (
                (axis.x(given.until_s), _bar_y(given, tops[robot]) + 2.5),
                (axis.x(taken.from_s), _bar_y(taken, tops[partner]) + 2.5),
            )
            (x1, y1), (x2, y2) = ends
            svg.add("line", x1=x1, y1=y1, x2=x2, y2=y2, class_="handed")
            for x, y in ends:
                svg.diamond(x, y, 5, "transfer")
