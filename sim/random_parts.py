"""Random parts: sizes and colours drawn over everything that a gripper fits and a camera meets."""

import colorsys
from dataclasses import dataclass, replace

import numpy as np

from mend.sim.workcell.gripper import PR2_GRIPPER
from mend.tasks.part_boxes import Size, height_of
from mend.tasks.scene import Pose, SceneObject

Color = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class DrawnSizes:
    """From what to what parts are drawn, metres and kilograms.

    `width_m` is the side that the fingers close on, `length_m` the other one. A plate is grasped
    by its knob.
    """

    width_m: tuple[float, float] = (PR2_GRIPPER.min_width_m, PR2_GRIPPER.max_width_m)
    length_m: tuple[float, float] = (PR2_GRIPPER.min_width_m, 0.300)
    height_m: tuple[float, float] = (PR2_GRIPPER.min_height_m, 0.150)
    slenderness: float = 5.0
    """A part is at most so many times as high as it is wide: higher ones fall over."""
    plate_side_m: tuple[float, float] = (0.050, 0.250)
    plate_height_m: tuple[float, float] = (0.008, 0.050)
    knob_width_m: tuple[float, float] = (PR2_GRIPPER.min_width_m, PR2_GRIPPER.max_width_m)
    knob_height_m: tuple[float, float] = (PR2_GRIPPER.min_height_m, 0.070)
    density_kg_m3: tuple[float, float] = (100.0, 3000.0)
    mass_kg: tuple[float, float] = (0.002, PR2_GRIPPER.max_mass_kg)

    def scaled(self, scale: float) -> "DrawnSizes":
        """The same with only the lowest fraction `scale` of every range of the boxes' sides."""

        def lower(limits: tuple[float, float]) -> tuple[float, float]:
            return limits[0], limits[0] + (limits[1] - limits[0]) * scale

        return replace(
            self,
            width_m=lower(self.width_m),
            length_m=lower(self.length_m),
            height_m=lower(self.height_m),
            plate_side_m=lower(self.plate_side_m),
        )


@dataclass(frozen=True, slots=True)
class PartLook:
    """What a part is, wherever it is."""

    size: Size
    knob: Size | None
    color: Color
    mass_kg: float

    @property
    def height_m(self) -> float:
        """From its bottom to its highest point."""
        return height_of(self.size, self.knob)

    def at(self, pose: Pose) -> SceneObject:
        """The part of a scene that starts at a pose."""
        return SceneObject(
            color=self.color, size=self.size, knob=self.knob, mass_kg=self.mass_kg, pose=pose
        )


PLATES = 0.2
"""So many of all parts are plates with a knob."""
SAME_COLOR = 0.2
"""So many of all kinds of part have the colour of an earlier one."""


def draw_look(rng: np.random.Generator, sizes: DrawnSizes, earlier: list[PartLook]) -> PartLook:
    """A part of a new kind; its colour may be that of an earlier one."""
    draw_body = _draw_plate if rng.random() < PLATES else _draw_box
    size, knob = draw_body(rng, sizes)
    color = draw_color(rng)
    if earlier and rng.random() < SAME_COLOR:
        color = earlier[int(rng.integers(len(earlier)))].color
    volume_m3 = float(np.prod(size))
    mass_kg = float(np.clip(volume_m3 * rng.uniform(*sizes.density_kg_m3), *sizes.mass_kg))
    return PartLook(size, knob, color, round(mass_kg, 3))


def draw_color(rng: np.random.Generator) -> Color:
    """Any colour, as linear RGB: bright, pale, dark and grey ones alike."""
    hue, saturation, value = rng.random(), rng.random() ** 0.5, rng.uniform(0.14, 1.0)
    red, green, blue = colorsys.hsv_to_rgb(hue, saturation, value)
    return round(red, 2), round(green, 2), round(blue, 2)


def _draw_box(rng: np.random.Generator, sizes: DrawnSizes) -> tuple[Size, Size | None]:
    width = rng.uniform(*sizes.width_m)
    length = rng.uniform(max(width, sizes.length_m[0]), max(width, sizes.length_m[1]))
    highest = min(sizes.height_m[1], sizes.slenderness * width)
    height = rng.uniform(sizes.height_m[0], max(sizes.height_m[0], highest))
    sides = (length, width) if rng.random() < 0.5 else (width, length)
    return _rounded(*sides, height), None


def _draw_plate(rng: np.random.Generator, sizes: DrawnSizes) -> tuple[Size, Size | None]:
    length, width = rng.uniform(*sizes.plate_side_m), rng.uniform(*sizes.plate_side_m)
    least, most = sizes.knob_width_m
    knob_width = rng.uniform(least, min(most, length, width))
    knob_length = rng.uniform(knob_width, min(length, width, 2 * knob_width))
    knob = (knob_width, knob_length) if rng.random() < 0.5 else (knob_length, knob_width)
    plate = _rounded(length, width, rng.uniform(*sizes.plate_height_m))
    return plate, _rounded(*knob, rng.uniform(*sizes.knob_height_m))


def _rounded(x: float, y: float, z: float) -> Size:
    return round(float(x), 3), round(float(y), 3), round(float(z), 3)
