"""Whether the head camera sees a part where it starts, and at its place."""

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.feasibility.moments import Job
from mend.robots.arm.feasibility.standing import Standing
from mend.robots.vision.line_of_sight import sight_of
from mend.robots.vision.seen_box import SeenBox
from mend.robots.vision.viewpoint import Viewpoint
from mend.tasks.scene import Scatter
from mend.tasks.scene_problem import SceneProblem

_LEAST_SHARE = 0.6
"""Of the top of a part; to less a rectangle cannot be fitted as exactly as a grasp needs it."""
_LEAST_AREA_M2 = 2.5e-4
_LEAST_SHARE_OF_SMALL = 0.9
"""Of so small a top hardly any may be hidden: few pixels are left, and edges have noise."""
_RIM_PX = 2.0
"""A side that is nearer to the rim of the picture is not seen to end there."""
_TURNS = 9
"""So many of the directions in which a scatter may turn a part are looked at."""


def hidden(
    start: Standing,
    around: Sequence[Standing],
    eye: NDArray[np.float64],
    moved: AbstractSet[str],
) -> SceneProblem | None:
    """What hides a part from a camera at `eye`; None if enough of it is seen.

    `moved` are the parts that leaves take away.
    """
    boxes = [box for each in around for box in each.boxes]
    sight = sight_of(eye, start.boxes[0], boxes)
    if sight.share >= _least_share(start.boxes[0]) or sight.hider is None:
        return None
    name, hider = start.name, sight.hider.name
    mend = "move one of them"
    if hider in moved:
        mend += f", or let {hider} be placed before {name}"
    return SceneProblem(start.where, f"{hider} hides {name} from the head camera: {mend}")


def _least_share(top: SeenBox) -> float:
    """The share of a part's top that has to be seen."""
    by_area = _LEAST_AREA_M2 / (top.size[0] * top.size[1])
    return max(_LEAST_SHARE, min(by_area, _LEAST_SHARE_OF_SMALL))


def out_of_picture(job: Job, head: Viewpoint, scatter: Scatter) -> SceneProblem | None:
    """That the head camera's picture does not hold a whole top; None if it does.

    Where the part starts, from wherever the scatter may put it, or at its place.
    """
    if not _in_picture(job.start, head, scatter):
        if scatter.xy > 0.0 and _in_picture(job.start, head, Scatter(yaw=scatter.yaw)):
            return SceneProblem(
                ("scatter", "xy"),
                f"a scatter of {1e3 * scatter.xy:g} mm may put {job.name} where the head camera's "
                f"picture does not hold all of it: make it smaller, or move {job.name} towards the "
                "middle of the table",
            )
        return _told_out_of_picture(job.start, "where it starts")
    if job.place is not None and not _in_picture(job.place, head, Scatter()):
        return _told_out_of_picture(job.place, "at its place")
    return None


def _in_picture(standing: Standing, head: Viewpoint, scatter: Scatter) -> bool:
    turns = np.linspace(-scatter.yaw, scatter.yaw, _TURNS if scatter.yaw else 1)
    for box in standing.boxes:
        turned = [replace(box, yaw=box.yaw + turn).corners() for turn in turns]
        shifts = scatter.xy * np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]])
        level = (np.concatenate(turned)[:, None] + shifts).reshape(-1, 2)
        corners = np.column_stack([level, np.full(len(level), box.top_z)])
        if not head.shows(corners, _RIM_PX):
            return False
    return True


def _told_out_of_picture(standing: Standing, when: str) -> SceneProblem:
    return SceneProblem(
        standing.where,
        f"the head camera's picture does not hold all of {standing.name} {when}: move it towards "
        "the middle of the table",
    )
