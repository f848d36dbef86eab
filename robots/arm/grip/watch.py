"""Follows one part between the fingers, from when they closed on it until they open."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from mend.robots.arm.grasp import Grasp, corners_in_tool
from mend.robots.arm.grip.belief import Belief, Between, Hypothesis
from mend.robots.arm.grip.composition import Composition, likeliest
from mend.robots.arm.grip.cues import CueModel, HandReading
from mend.robots.arm.grip.reading import GRIP, GripReading, GripState
from mend.robots.arm.grip.rivals import Rival, RivalView
from mend.robots.arm.grip.view import (
    REFERENCE_WIDTH_PX,
    composition,
    in_front,
    in_tool,
    near_tool,
    outline,
    visible_region,
)
from mend.robots.arm.gripper import GripperModel
from mend.robots.body import CameraImage, Matrix4
from mend.robots.catalogue import Part
from mend.robots.vision.blob import Blob, Mask, find_blob
from mend.robots.vision.color_model import ColorModel, Segmentation
from mend.robots.vision.projection import project
from mend.robots.vision.seen_box import SeenBox

_SURE = 0.99
_LONGEST_DOUBT = 12
"""After so many readings that leave it unsure the likelier verdict stands."""

_PRESSES_SHARE = 0.5
"""Fingers press on something if they do so with this share of their force."""

_PUSHED_N = 10.0
"""More than a hand feels while it carries something freely."""

_OVERHANG_PX = 3.0
"""A part hangs over its outline by no more, in a picture 160 pixels wide, while it stays put."""
_STRAY_SHARE = 0.1
_LEAST_BLOB_PX = 12


@dataclass(frozen=True, slots=True, eq=False)
class HandSnapshot:
    """The hand at one moment: its picture, where it is, and what the fingers feel.

    `tool` is the tool point's pose; `fingers` are the convex pieces (n, 3) of the gripper in the
    tool frame that may hide what is held, and so may `around`, what was last seen on the table (in
    the base frame). `contact_n` is how hard something pushes against the arm.
    """

    image: CameraImage
    tool: Matrix4
    opening_m: float
    effort_n: float
    contact_n: float
    fingers: Sequence[NDArray[np.float64]]
    around: Sequence[SeenBox] = ()


class GripWatch:
    """Judges one part's grip, reading by reading."""

    def __init__(
        self,
        part: Part,
        grasp: Grasp,
        model: ColorModel,
        gripper: GripperModel,
        cues: CueModel | None = None,
        *,
        regrasp: bool = False,
        rivals: Sequence[Rival] = (),
    ) -> None:
        """`regrasp`: what is not between the fingers as planned may be grasped anew.

        `rivals` may be there in the part's stead, until the first verdict.
        """
        self.part = part
        self.grasp = grasp
        self._model = model
        self._gripper = gripper
        self._cues = cues or CueModel()
        self._regrasp = regrasp
        self._rivals = rivals
        self._boxes = corners_in_tool(part, grasp)
        self._near = near_tool(part, grasp)
        self._belief = Belief(len(rivals))
        self._state = GripState.UNDECIDED
        self._pushed = False
        """Whether something has pushed against the arm since the fingers closed."""
        self._unsure = 0
        """So many readings on end left it unsure."""
        self._shift: NDArray[np.float64] = np.zeros(2)
        self._read_s: float | None = None

    @property
    def state(self) -> GripState:
        return self._state

    @property
    def probability(self) -> float:
        """How sure it is that the part is held."""
        return self._belief.probability

    @property
    def in_doubt(self) -> bool:
        """Whether the next reading may change the verdict."""
        wavering = self._state is GripState.HELD and 0 < self._unsure < _LONGEST_DOUBT
        return self._state is GripState.UNDECIDED or wavering

    def update(self, hand: HandSnapshot) -> GripReading:
        """Take a reading into account."""
        reading = self.measure(hand)
        now_s = hand.image.time
        if self._read_s is not None:
            self._belief.predict(max(0.0, now_s - self._read_s))
        self._read_s = now_s
        if hand.contact_n >= _PUSHED_N:
            self._belief.push()
        self._belief.update(self._log_likelihoods(reading))
        self._pushed = reading.pushed
        if self._state is GripState.UNDECIDED:
            self._learn(reading)
        self._judge()
        return replace(reading, state=self._state, probability=self.probability)

    def _learn(self, reading: GripReading) -> None:
        """An uneven grasp is where the part is from now on."""
        blob, overhang_px = reading.blob, reading.overhang_px
        if blob is not None and overhang_px is not None and overhang_px > _OVERHANG_PX:
            scale = reading.image.bgr.shape[1] / REFERENCE_WIDTH_PX
            self._shift = self._shift + (np.array(blob.center) - reading.expected) / scale

    def measure(self, hand: HandSnapshot) -> GripReading:
        """Read the hand without coming to a verdict; `probability` is this reading's alone."""
        image = hand.image
        scale = image.bgr.shape[1] / REFERENCE_WIDTH_PX
        segmentation = self._model.segment(image.bgr)
        whole = outline(image, hand.tool, self._boxes, self._shift * scale)
        blob = find_blob(
            segmentation.mask(self.part.name),
            min_area_px=max(6, round(_LEAST_BLOB_PX * scale * scale)),
            whole=True,
        )
        hiding = [*hand.fingers, *in_front(image, hand.tool, hand.around)]
        seen = self._composition(hand, segmentation, hiding)
        around = in_tool(image, hand.tool, hand.around)
        rivals = RivalView(image, hand.tool, segmentation, self._model, hiding, around)
        reading = GripReading(
            name=self.part.name,
            state=self._state,
            probability=0.5,
            opening_m=hand.opening_m,
            width_m=self.grasp.width_m,
            by_knob=self.part.knob is not None,
            presses=hand.effort_n >= _PRESSES_SHARE * self._gripper.grip_force_n,
            pushed=self._pushed or hand.contact_n >= _PUSHED_N,
            composition=seen,
            blob=blob,
            expected=_center(whole, project(image, hand.tool[None, :3, 3])[0]),
            tolerance_px=_OVERHANG_PX * scale,
            overhang_px=None if blob is None else _overhang_px(blob, whole) / scale,
            image=image,
            rivals=rivals.read(self._rivals_left, self.part.name, self._boxes, seen),
        )
        alone = Belief(len(self._rivals_left))
        alone.update(self._log_likelihoods(reading))
        return replace(reading, probability=alone.probability)

    @property
    def _rivals_left(self) -> Sequence[Rival]:
        """What is held stays what it is."""
        return self._rivals if self._state is GripState.UNDECIDED else ()

    def _composition(
        self,
        hand: HandSnapshot,
        segmentation: Segmentation,
        hiding: Sequence[NDArray[np.float64]],
    ) -> Composition | None:
        region = visible_region(hand.image, hand.tool, self._near, hiding)
        return composition(region, segmentation, self._model, self.part.name)

    def _log_likelihoods(self, reading: GripReading) -> Mapping[Hypothesis, float]:
        seen = reading.composition
        if self._state is GripState.HELD and seen is not None and likeliest(seen) == "nothing":
            # What fingers still press on is hidden, and stays what it is however long.
            seen = None
        hand = HandReading(reading.opening_m, reading.presses, seen, reading.pushed, reading.rivals)
        return self._cues.log_likelihoods(hand, self.grasp, self._gripper)

    def _judge(self) -> None:
        sure = self.probability >= _SURE or self.probability <= 1.0 - _SURE
        self._unsure = 0 if sure else self._unsure + 1
        if self._state is GripState.UNDECIDED and (sure or self._unsure >= _LONGEST_DOUBT):
            self._state = GRIP.require(self._state, self._first_verdict())
            self._belief.forget_rivals()
        elif self._state is GripState.HELD and self.probability <= 1.0 - _SURE:
            self._state = GRIP.require(self._state, GripState.LOST)

    def _first_verdict(self) -> GripState:
        as_planned = max(self._belief.of(Between.STRAIGHT), self._belief.of(Between.NOTHING))
        held = self.probability >= 0.5
        if self._regrasp and as_planned < 0.5 and (self._pushed or not held):
            return GripState.ASKEW
        return GripState.HELD if held else GripState.ABSENT


def _center(canvas: Mask, fallback: NDArray[np.float64]) -> tuple[float, float]:
    found = cv2.moments(canvas, binaryImage=True)
    if found["m00"] < 1:
        return float(fallback[0]), float(fallback[1])
    return found["m10"] / found["m00"], found["m01"] / found["m00"]


def _overhang_px(blob: Blob, whole: Mask) -> float:
    """How far the blob lies outside, but for the share of it that is farthest out."""
    if not whole.any():
        return float("inf")
    outside = np.asarray(cv2.distanceTransform(1 - whole, cv2.DIST_L2, 3))
    return float(np.quantile(outside[blob.mask > 0], 1.0 - _STRAY_SHARE))
