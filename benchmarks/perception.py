"""How well the head camera finds and names the parts of random scenes, against a plain locator.

    python benchmarks/perception.py [--scenes N] [--seed S] [--noise G] [--verbose]

Scenes have 1 to 30 parts of all sizes, equal ones, close ones and stacks, in noise of colour and
depth and in varying light; each is looked at as it
starts and as it is to be in the end. A part
is unoccluded if at least 95 % of its top is seen by the camera. Equal parts count as the same. An
error of yaw is also given as how far it moves the corners: a small part has few pixels of yaw.
The plain locator takes the largest blob of a part's colours and the middle of its highest layer.
"""

# ruff: noqa: T201

import argparse
import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from mend.errors import WrongInputError
from mend.robots.body import CameraImage
from mend.robots.catalogue import Catalogue, Part
from mend.robots.vision.blob import find_blob
from mend.robots.vision.color_model import ColorModel
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.lookalikes import find_lookalikes
from mend.robots.vision.projection import pixels_covered, unproject
from mend.robots.vision.table_view import TableView, view_table
from mend.robots.vision.tracking import LastSeen
from mend.sim.random_scene import random_scene
from mend.sim.workcell.colors import learn_colors
from mend.sim.workcell.options import WorkcellOptions
from mend.sim.workcell.parts import RigidPart as WorldPart
from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.definition import BehaviorNode
from mend.tasks.scene import Scene
from mend.tasks.scene_problem import SceneProblem

UNOCCLUDED = 0.95
VISIBLE = 0.5
SAME_M = 0.010
_TILTED_RAD = 0.05
_LAYER_M = 0.005


@dataclass(frozen=True, slots=True)
class Truth:
    """Where a part really is, and how much of its top the camera sees."""

    part: Part
    x: float
    y: float
    z: float
    yaw: float
    shown: float
    tilted: bool


@dataclass(slots=True)
class Tally:
    """What came of all looks."""

    unoccluded: int = 0
    found: int = 0
    visible: int = 0
    visible_found: int = 0
    wrong: list[str] = field(default_factory=list)
    missed: list[str] = field(default_factory=list)
    invented: int = 0
    error_mm: list[float] = field(default_factory=list)
    yaw_deg: list[float] = field(default_factory=list)
    corner_mm: list[float] = field(default_factory=list)
    worst: list[str] = field(default_factory=list)
    cpu_s: list[float] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Spot:
    """Where a locator says that a part is."""

    x: float
    y: float
    yaw: float | None


def truths(world: WorkcellWorld, catalogue: Catalogue) -> tuple[CameraImage, dict[str, Truth]]:
    """A noisy picture, and what it was rendered from."""
    image, rendering = world.head.capture_with_bodies()
    clean = CameraImage(
        image.bgr, rendering.depth_m, image.pose, image.focal_px, image.center_px, image.time
    )
    found = {}
    for name, part in world.parts.items():
        found[name] = _truth(catalogue.parts[name], part, clean, rendering.bodies)
    return image, found


def _truth(part: Part, real: WorldPart, clean: CameraImage, bodies: NDArray[np.int32]) -> Truth:
    pose = real.pose()
    x, y, z = pose.position
    vs, us = np.nonzero(bodies == real.body_id)
    points = unproject(clean, us, vs)
    top_z = z + part.size[2]
    on_top = np.count_nonzero(np.abs(points[:, 2] - top_z) < 0.0015)
    whole = pixels_covered(clean, (x, y, top_z), part.size[:2])
    if part.knob is not None:
        whole -= 1.6 * pixels_covered(clean, (x, y, top_z), part.knob[:2])
    return Truth(
        part, x, y, z, pose.yaw, on_top / max(whole, 1.0), abs(pose.tilt_rad) > _TILTED_RAD
    )


def plain_spots(image: CameraImage, catalogue: Catalogue, model: ColorModel) -> dict[str, Spot]:
    """The largest blob of each part's colours."""
    segmentation = model.segment(image.bgr)
    spots = {}
    for name in catalogue.parts:
        blob = find_blob(segmentation.mask(name))
        if blob is None:
            continue
        vs, us = np.nonzero(blob.mask)
        points = unproject(image, us, vs)
        points = points[np.isfinite(points[:, 2])]
        if len(points) == 0:
            continue
        top_z = np.percentile(points[:, 2], 90)
        x, y = points[np.abs(points[:, 2] - top_z) < _LAYER_M, :2].mean(axis=0)
        spots[name] = Spot(float(x), float(y), None)
    return spots


def seen_spots(sightings: Mapping[str, HeadSighting]) -> dict[str, Spot]:
    return {name: Spot(each.x, each.y, each.yaw) for name, each in sightings.items()}


def judge(
    spots: Mapping[str, Spot],
    real: Mapping[str, Truth],
    look: Mapping[str, str],
    tally: Tally,
    scene: Scene,
) -> None:
    """Compare what was found with what is there; `look` gives equal parts one name."""
    taken: set[str] = set()
    for name, spot in spots.items():
        near = [
            (math.hypot(spot.x - each.x, spot.y - each.y), other)
            for other, each in real.items()
            if look[other] == look[name] and other not in taken
        ]
        distance_m, other = min(near, default=(math.inf, ""))
        if distance_m > SAME_M:
            tally.wrong.append(f"{scene.name}: {name} at {spot.x:.3f} {spot.y:.3f}")
            continue
        taken.add(other)
        _measure(spot, real[other], other, distance_m, tally, scene)
    for name, each in real.items():
        tally.unoccluded += each.shown >= UNOCCLUDED
        tally.found += each.shown >= UNOCCLUDED and name in taken
        tally.visible += each.shown >= VISIBLE
        tally.visible_found += each.shown >= VISIBLE and name in taken
        if each.shown >= VISIBLE and name not in taken:
            tally.missed.append(
                f"{scene.name}: {name} {each.part.size} {each.part.knob} shown {each.shown:.2f}"
                f" at {each.x:.3f} {each.y:.3f} {each.z:.3f}"
                f" {scene.objects[name].color}{' tilted' if each.tilted else ''}"
            )


def _measure(
    spot: Spot, real: Truth, name: str, distance_m: float, tally: Tally, scene: Scene
) -> None:
    if real.shown < UNOCCLUDED or real.tilted:
        return
    tally.error_mm.append(distance_m * 1e3)
    turned = None
    if spot.yaw is not None:
        x, y = real.part.size[:2]
        period = math.pi / 2 if abs(x - y) < 0.002 else math.pi
        turned = abs((spot.yaw - real.yaw + period / 2) % period - period / 2)
        tally.yaw_deg.append(math.degrees(turned))
        tally.corner_mm.append(turned * math.hypot(x, y) / 2 * 1e3)
    tally.worst.append(
        f"{distance_m * 1e3:6.2f} mm {math.degrees(turned or 0):5.1f} deg {scene.name} {name} "
        f"{real.part.size} {real.part.knob} shown {real.shown:.2f}"
    )


def show(title: str, tally: Tally, *, verbose: bool) -> None:
    """Print one locator's figures."""
    print(f"{title}")
    print(
        f"  unoccluded parts found {tally.found}/{tally.unoccluded}, "
        f"half visible or more {tally.visible_found}/{tally.visible}"
    )
    print(
        f"  wrongly named or nowhere {len(tally.wrong)}, unknown things invented {tally.invented}"
    )
    for what, values, unit in (
        ("position", tally.error_mm, "mm"),
        ("yaw", tally.yaw_deg, "deg"),
        ("yaw at the corners", tally.corner_mm, "mm"),
    ):
        if values:
            p50, p95, most = np.percentile(values, [50, 95, 100])
            print(
                f"  {what} error of unoccluded ones p50 {p50:.2f} p95 {p95:.2f} "
                f"max {most:.2f} {unit}"
            )
    if tally.cpu_s:
        print(
            f"  CPU per look {np.median(tally.cpu_s) * 1e3:.0f} ms, "
            f"max {max(tally.cpu_s) * 1e3:.0f} ms"
        )
    if verbose:
        for line in (*tally.wrong, *tally.missed, *sorted(tally.worst)[-8:]):
            print("   ", line)


def _view(image: CameraImage, catalogue: Catalogue, model: ColorModel, tally: Tally) -> TableView:
    started = time.process_time()
    view = view_table(image, catalogue.table, catalogue.parts, model, LastSeen(catalogue.starts))
    tally.cpu_s.append(time.process_time() - started)
    assert view is not None
    return view


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0, help="of the first scene")
    parser.add_argument("--noise", type=float, default=4.0, help="of colour, grey levels")
    parser.add_argument("--verbose", action="store_true", help="tell what was missed and the worst")
    chosen = parser.parse_args(arguments)
    ours, plain = Tally(), Tally()
    for seed in range(chosen.seed, chosen.seed + chosen.scenes):
        try:
            scene = random_scene(seed, check=_check).scene
        except WrongInputError:
            print(f"seed {seed}: no scene was found")
            continue
        for each in (scene, _worked_off(scene)):
            look_at(each, seed, chosen.noise, ours, plain)
    show("segmentation by depth and colour, one assignment", ours, verbose=chosen.verbose)
    show("largest blob of colour", plain, verbose=False)


def _check(scene: Scene, leaves: Sequence[BehaviorNode]) -> list[SceneProblem]:
    return find_lookalikes(scene, leaves, learn_colors(scene))


def _worked_off(scene: Scene) -> Scene:
    """The same scene with every part where it is to go."""
    places = [each.pose for each in scene.places.values()]
    objects = {
        name: each.model_copy(update={"pose": place})
        for (name, each), place in zip(scene.objects.items(), places, strict=True)
    }
    return scene.model_copy(update={"name": f"{scene.name}_placed", "objects": objects})


def look_at(scene: Scene, seed: int, noise: float, ours: Tally, plain: Tally) -> None:
    """One look at one scene by both locators."""
    options = WorkcellOptions(camera_noise=noise, light=1.0, depth_noise=1.0)
    world = WorkcellWorld(scene, seed, options)
    catalogue, model = Catalogue.from_scene(scene), learn_colors(scene, noise)
    image, real = truths(world, catalogue)
    world.close()
    look = {name: repr((each.size, each.knob, each.color)) for name, each in scene.objects.items()}
    view = _view(image, catalogue, model, ours)
    ours.invented += sum(box.name is None for box in view.boxes)
    judge(seen_spots(view.sightings), real, look, ours, scene)
    judge(plain_spots(image, catalogue, model), real, look, plain, scene)


if __name__ == "__main__":
    main()
