"""What a picture costs with PyBullet's renderer and with the fast one, of the same moment.

    python benchmarks/camera.py [--quick]

The ratio is that of CPU time per picture; beside it, how far the two pictures differ.
"""

# ruff: noqa: T201

import argparse
import time
from dataclasses import replace
from typing import Literal

import numpy as np

from mend.sim.workcell.cameras import Optics, WorkcellCamera, forearm_optics, head_optics
from mend.sim.workcell.options import WorkcellOptions
from mend.sim.workcell.world import WorkcellWorld
from mend.tasks.scene_file import built_in_scene

CAMERAS: tuple[tuple[Literal["head", "forearm"], Optics], ...] = (
    ("forearm", forearm_optics(0.1)),
    ("head", head_optics()),
)
MOVED = "pink_bar"
SCALES = (0.5, 1.0, 2.0)


def scaled(optics: Optics, scale: float) -> Optics:
    """The same camera with more or fewer pixels."""
    width, height = (round(side * scale) for side in optics.size)
    return Optics(
        (width, height), optics.focal_px * scale, optics.near_m, optics.period_s, optics.has_depth
    )


def cost_ms(camera: WorkcellCamera, world: WorkcellWorld, pictures: int) -> float:
    """Mean CPU time per picture, after one that warms up.

    A part moves before each: of what has not changed the last picture is taken again.
    """
    camera.capture()
    part = world.parts[MOVED]
    start, spent_s = part.pose(), 0.0
    for number in range(pictures):
        x, y, z = start.position
        part.put(replace(start, position=(x + 1e-4 * (number % 2), y, z)))
        begin_s = time.process_time()
        camera.capture()
        spent_s += time.process_time() - begin_s
    part.put(start)
    return spent_s / pictures * 1e3


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="five pictures each")
    pictures = 5 if parser.parse_args().quick else 100
    scene = built_in_scene("eket")
    worlds = {
        renderer: WorkcellWorld(scene, 1, WorkcellOptions(renderer=renderer))
        for renderer in ("bullet", "fast")
    }
    print("| camera | size | PyBullet, ms | fast, ms | ratio | depth differs, mm (median) |")
    print("|---|---|---:|---:|---:|---:|")
    for name, optics in CAMERAS:
        for scale in SCALES:
            size = scaled(optics, scale)
            cameras = {renderer: world.camera(name, size) for renderer, world in worlds.items()}
            bullet, fast = (
                cost_ms(camera, worlds[renderer], pictures) for renderer, camera in cameras.items()
            )
            (_, one), (_, other) = (each.capture_with_bodies() for each in cameras.values())
            apart = np.median(np.abs(one.depth_m - other.depth_m)) * 1e3
            print(
                f"| {name} | {size.size[0]} x {size.size[1]} | {bullet:.2f} | {fast:.2f} "
                f"| {bullet / fast:.1f} x | {apart:.3f} |"
            )


if __name__ == "__main__":
    main()
