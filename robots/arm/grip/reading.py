"""What a reading of the hand says, and the verdict with it."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from mend.robots.arm.grip.composition import Composition
from mend.robots.arm.grip.rivals import RivalReading
from mend.robots.body import CameraImage
from mend.robots.vision.blob import Blob
from mend.tasks.transitions import Transitions

_MM = 1e3
_ALL_ITS_OWN = 0.8
"""Where so much is seen of its colour it is not its looks that tell against it."""


class GripState(StrEnum):
    """The verdict since the gripper closed."""

    UNDECIDED = "undecided"
    HELD = "held"
    ABSENT = "absent"
    """The object never was between the fingers."""
    ASKEW = "askew"
    """The fingers have closed on something, but not on the object as they were to."""
    LOST = "lost"
    """It was held, and is not any more."""


GRIP = Transitions(
    "the grip",
    {
        GripState.UNDECIDED: (GripState.HELD, GripState.ABSENT, GripState.ASKEW),
        GripState.HELD: (GripState.LOST,),
        GripState.ABSENT: (),
        GripState.ASKEW: (),
        GripState.LOST: (),
    },
)
"""Which verdict may follow which."""


@dataclass(frozen=True, slots=True, eq=False)
class GripReading:
    """One reading of opening, effort and picture, and the verdict with it.

    `probability` is how sure it is that `name` is held rightly. The fingers are `opening_m` apart
    where the part, or its knob if it is held `by_knob`, is `width_m` wide; `presses`: they press on
    something, `pushed`: something has pushed against the arm since they closed. `composition` says
    which colours the picture shows where the part must be seen; None where the fingers hide it or
    its colour cannot be told. `blob` are the pixels of its colours, `expected` the centre of its
    outline (pixels) and `overhang_px` how far the blob hangs over that, for a picture 160 pixels
    wide; `tolerance_px` of it are usual. `rivals` are the known parts that it may be instead.
    """

    name: str
    state: GripState
    probability: float
    opening_m: float
    width_m: float
    by_knob: bool
    presses: bool
    pushed: bool
    composition: Composition | None
    blob: Blob | None
    expected: tuple[float, float]
    tolerance_px: float
    overhang_px: float | None
    image: CameraImage
    rivals: Sequence[RivalReading] = ()

    @property
    def reason(self) -> str:
        """Why it was not held at that moment, if it was not: the strongest sign of it."""
        name = self.name.replace("_", " ")
        opening, width = self.opening_m * _MM, self.width_m * _MM
        seen = self.composition
        held = f"the knob of the {name}" if self.by_knob else f"the {name}"
        wide = f"where {held} is {width:.0f} mm wide"
        if abs(opening - width) > width / 3 or not self.presses:
            if opening < width:
                return f"the fingers closed to {opening:.0f} mm {wide}"
            return f"the fingers were {opening:.0f} mm apart {wide}"
        if seen is not None and seen.most_other is not None and seen.other > seen.own:
            other = seen.most_other.replace("_", " ")
            return f"what was between the fingers had the colours of the {other}, not the {name}"
        if abs(opening - width) > width / 10 or (seen is not None and seen.own > _ALL_ITS_OWN):
            return f"the fingers were {opening:.0f} mm apart {wide}"
        return f"what was between the fingers did not look like the {name}"
