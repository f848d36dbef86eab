"""Whether the head camera sees a part where it starts."""

from collections.abc import Sequence
from collections.abc import Set as AbstractSet

import numpy as np
from numpy.typing import NDArray

from robots.feasibility.standing import Standing
from robots.vision.line_of_sight import sight_of
from robots.vision.seen_box import SeenBox
from tasks.scene_problem import SceneProblem

_LEAST_SHARE = 0.6
"""Of the top of a part; to less a rectangle cannot be fitted as exactly as a grasp needs it."""
_LEAST_AREA_M2 = 2.5e-4
_LEAST_SHARE_OF_SMALL = 0.9
"""Of so small a top hardly any may be hidden: few pixels are left, and edges have noise."""


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
