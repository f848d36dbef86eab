"""Where everybody drives: places, routes, and the places where items change robots."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import hypot

from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Action, Schedule
from mend.maps.svg import FONT_PX, Svg, color, text_width_px

MARGIN_PX = 70.0
MOST_HEIGHT_PX = 520.0
APART_PX = 3.0
"""How far apart the routes of two robots along the same line are."""

Point = tuple[float, float]
Box = tuple[float, float, float, float]


def draw_map(
    svg: Svg, problem: Problem, schedule: Schedule, robots: Sequence[int], top: float, width: float
) -> float:
    """Draw the routes of these robots from `top` downwards; returns where the drawing ends.

    Raises `ValueError` for a problem whose places have no coordinates.
    """
    if problem.coordinates is None:
        raise ValueError("places without coordinates cannot be drawn")
    points, bottom = _on_paper(problem.coordinates, top, width)
    for order, robot in enumerate(robots):
        shift = APART_PX * (order - (len(robots) - 1) / 2)
        _draw_route(svg, points, _stations(problem, schedule, robot), color(robot), shift)
    handed = {
        stop.task.place
        for robot in schedule.robots
        for stop in robot.stops
        if stop.task.action is Action.GIVE
    }
    homes = {problem.robots[robot].start for robot in robots}
    for place, (x, y) in enumerate(points):
        if place in handed:
            svg.diamond(x, y, 8, "transfer")
        elif place in homes:
            svg.add("rect", x=x - 5, y=y - 5, width=10, height=10, class_="busy")
        else:
            svg.add("circle", cx=x, cy=y, r=3.2, class_="place")
    routes = [_stations(problem, schedule, robot) for robot in robots]
    visited = sorted({place for route in routes for place in route})
    named = list(dict.fromkeys([*sorted(handed), *sorted(homes), *visited, *range(len(points))]))
    _draw_names(svg, problem, points, named, _along(points, routes))
    return _draw_legend(svg, problem, robots, bottom, width)


def _on_paper(coordinates: Sequence[Point], top: float, width: float) -> tuple[list[Point], float]:
    """The places in the picture, north up, and where the picture ends."""
    xs, ys = [x for x, _ in coordinates], [y for _, y in coordinates]
    wide, high = max(xs) - min(xs) or 1.0, max(ys) - min(ys)
    scale = min((width - 2 * MARGIN_PX) / wide, MOST_HEIGHT_PX / (high or 1.0))
    left = (width - scale * wide) / 2
    points = [
        (left + scale * (x - min(xs)), top + 24 + scale * (max(ys) - y)) for x, y in coordinates
    ]
    return points, top + 48 + scale * high


def _stations(problem: Problem, schedule: Schedule, robot: int) -> list[int]:
    """Where a robot is, one place after the other."""
    described = problem.robots[robot]
    places = [described.start, *(stop.task.place for stop in schedule.robots[robot].stops)]
    if described.end is not None:
        places.append(described.end)
    return [places[0], *(b for a, b in pairwise(places) if a != b)]


def _draw_route(
    svg: Svg, points: Sequence[Point], stations: Sequence[int], stroke: str, shift: float
) -> None:
    """Lines beside those of other robots, with an arrow in the middle of each."""
    for a, b in pairwise(stations):
        (x1, y1), (x2, y2) = points[a], points[b]
        length = hypot(x2 - x1, y2 - y1)
        if length < 1:
            continue
        dx, dy = (x2 - x1) / length, (y2 - y1) / length
        # Every robot has its side of a line; its way back lies beside its way there.
        aside = (2 * shift if points[a] < points[b] else -2 * shift) + APART_PX / 2
        ox, oy = -dy * aside, dx * aside
        svg.add(
            "line", x1=x1 + ox, y1=y1 + oy, x2=x2 + ox, y2=y2 + oy,
            stroke=stroke, stroke_width=2.0, stroke_linecap="round",
        )  # fmt: skip
        x, y = (x1 + x2) / 2 + ox, (y1 + y2) / 2 + oy
        tip, left, right = (
            (x + 6 * dx, y + 6 * dy),
            (x - 4 * dx - 4 * dy, y - 4 * dy + 4 * dx),
            (x - 4 * dx + 4 * dy, y - 4 * dy - 4 * dx),
        )
        path = "M" + "L".join(f"{px:.1f} {py:.1f}" for px, py in (tip, left, right)) + "z"
        svg.add("path", d=path, fill=stroke)


def _along(points: Sequence[Point], routes: Sequence[Sequence[int]]) -> list[Box]:
    """Small boxes along all routes, which names had better not cover."""
    boxes = []
    for a, b in {pair for route in routes for pair in pairwise(route)}:
        (x1, y1), (x2, y2) = points[a], points[b]
        steps = max(1, int(hypot(x2 - x1, y2 - y1) / 8))
        for step in range(steps + 1):
            x, y = x1 + (x2 - x1) * step / steps, y1 + (y2 - y1) * step / steps
            boxes.append((x - 2, y - 2, x + 2, y + 2))
    return boxes


def _draw_names(
    svg: Svg,
    problem: Problem,
    points: Sequence[Point],
    order: Sequence[int],
    routes: Sequence[Box],
) -> None:
    """Names beside their places, the important ones first; one that finds no room is left out."""
    taken: list[Box] = [(x - 6, y - 6, x + 6, y + 6) for x, y in dict.fromkeys(points)]
    for place in order:
        name = problem.places[place]
        free = [
            (corner, box)
            for corner, box in _beside(points[place], name)
            if not any(_overlap(box, other) for other in taken)
        ]
        if free:
            corner, box = min(
                free, key=lambda each: sum(_overlap(each[1], other) for other in routes)
            )
            taken.append(box)
            svg.text(*corner, name, "halo")


def _beside(point: Point, name: str) -> Iterator[tuple[Point, Box]]:
    """Where a name could stand: the beginning of its baseline, and the room that it takes."""
    (x, y), wide = point, text_width_px(name)
    for left, baseline in (
        (x + 10, y + 4), (x - 10 - wide, y + 4), (x - wide / 2, y - 11), (x - wide / 2, y + 19),
        (x + 8, y - 8), (x - 8 - wide, y - 8), (x + 8, y + 16), (x - 8 - wide, y + 16),
    ):  # fmt: skip
        yield (left, baseline), (left, baseline - FONT_PX, left + wide, baseline + 3)


def _overlap(a: Box, b: Box) -> bool:
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def _draw_legend(
    svg: Svg, problem: Problem, robots: Sequence[int], top: float, width: float
) -> float:
    """Which colour is which robot; a diamond is a transfer."""
    x, y = 16.0, top + 12
    entries = [(problem.robots[robot].name, color(robot)) for robot in robots]
    for name, fill in [*entries, ("transfer", "")]:
        wide = text_width_px(name) + 34
        if x + wide > width - 16:
            x, y = 16.0, y + 18
        if fill:
            svg.add("rect", x=x, y=y - 6, width=14, height=4, rx=2, fill=fill)
        else:
            svg.diamond(x + 7, y - 4, 5, "transfer")
        svg.text(x + 20, y, name)
        x += wide
    return y + 16
