"""What else of the known parts may be between the fingers, where a person put it there.

Two parts of one colour are told apart by the fingers if they are not equally wide there, and by
the forearm camera where one of them would be seen and the other never.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.grasp import can_grasp, corners_in_tool, grasps_of
from mend.robots.arm.grip.composition import Composition, log_density
from mend.robots.arm.grip.view import composition, outline, rim_of, visible_region
from mend.robots.arm.gripper import GripperModel
from mend.robots.body import CameraImage, Matrix4
from mend.robots.catalogue import Part
from mend.robots.vision.color_model import ColorModel, Segmentation

Pieces = Sequence[NDArray[np.float64]]
"""Convex ones, by their corners (n, 3) in the tool frame."""


@dataclass(frozen=True, slots=True)
class Rival:
    """Another part, held in one of the ways in which it can be; `alike`: it has the same hue."""

    name: str
    width_m: float
    pieces: Pieces
    alike: bool


@dataclass(frozen=True, slots=True)
class RivalReading:
    """How a rival fits what is seen: log p(picture | it is held), as `log_density` has it.

    `alike`: looks hardly tell it from the part, so that the fingers have to.
    """

    width_m: float
    log_looks: float
    alike: bool


def rivals_of(
    part: Part, among: Iterable[Part], model: ColorModel, gripper: GripperModel
) -> list[Rival]:
    """Every way of holding what the hand can tell from a part in some way or other."""
    found = []
    for other in among:
        alike = model.may_pass_for(other.name, part.name)
        if (alike and other.equals(part)) or not can_grasp(other, gripper):
            continue
        ways = {each.yaw: each for each in reversed(grasps_of(other, gripper))}
        found += [
            Rival(other.name, each.width_m, corners_in_tool(other, each), alike)
            for each in ways.values()
        ]
    return found


@dataclass(frozen=True, slots=True)
class RivalView:
    """One picture in which rivals are looked for.

    `hiding` are pieces that may hide what is held, `around` those that may be seen beside it.
    """

    image: CameraImage
    tool: Matrix4
    segmentation: Segmentation
    model: ColorModel
    hiding: Pieces
    around: Pieces

    def read(
        self, rivals: Sequence[Rival], part: str, pieces: Pieces, seen: Composition | None
    ) -> list[RivalReading]:
        """How each rival fits what is `seen` where a part of such pieces must be."""
        readings = []
        for each in rivals:
            looks = 0.0 if seen is None else log_density(seen, "right" if each.alike else "other")
            if each.alike:
                looks += self._log_odds_beyond(each.name, each.pieces, pieces)
                looks -= self._log_odds_beyond(part, pieces, each.pieces)
            else:
                looks += self._log_odds_of_any(each)
            readings.append(RivalReading(each.width_m, looks, each.alike))
        return readings

    def _log_odds_of_any(self, rival: Rival) -> float:
        """Of a rival against any other thing, by what is seen where the rival must be."""
        region = visible_region(self.image, self.tool, rival.pieces, self.hiding)
        seen = composition(region, self.segmentation, self.model, rival.name)
        return 0.0 if seen is None else log_density(seen, "right") - log_density(seen, "other")

    def _log_odds_beyond(self, name: str, pieces: Pieces, other: Pieces) -> float:
        """Of a part against nothing, where it must be seen and another never would be."""
        region = visible_region(self.image, self.tool, pieces, self.hiding)
        shown = outline(self.image, self.tool, [*other, *map(_turned, other), *self.around])
        never = np.asarray(cv2.dilate(shown, rim_of(self.image)), np.uint8)
        region = np.where(never > 0, 0, region).astype(np.uint8)
        beyond = composition(region, self.segmentation, self.model, name)
        if beyond is None:
            return 0.0
        return log_density(beyond, "right") - log_density(beyond, "nothing")


def _turned(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """A piece of a part that is held the other way round."""
    return np.asarray(corners[:, [0, 2, 1]] * (1.0, 1.0, -1.0))
