"""The whole picture of a schedule: what it costs, when who does what, and where."""

from mend.fleet.scheduling.drawing.gantt import draw_gantt
from mend.fleet.scheduling.drawing.route_map import draw_map
from mend.fleet.scheduling.problem import Problem
from mend.fleet.scheduling.schedule import Schedule
from mend.maps.svg import Svg

WIDTH_PX = 1000.0


def picture(problem: Problem, schedule: Schedule, summary: str = "") -> str:
    """A schedule as SVG. The map is left out where places have no coordinates."""
    svg = Svg()
    used = [number for number, robot in enumerate(schedule.robots) if robot.used]
    svg.text(16, 28, problem.name, "title")
    svg.text(16, 46, summary, "soft")
    bottom = draw_gantt(svg, problem, schedule, used, 72, WIDTH_PX)
    if problem.coordinates is not None:
        bottom = draw_map(svg, problem, schedule, used, bottom + 12, WIDTH_PX)
    return svg.document(WIDTH_PX, bottom + 8, f"{problem.name}: {summary}")
