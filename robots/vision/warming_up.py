"""Compiling what vision calls, before a robot is at work."""

from functools import cache

import numpy as np

from mend.robots.body import CameraImage
from mend.robots.vision.evidence import gather
from mend.robots.vision.height_map import measure_heights
from mend.robots.vision.level_surfaces import find_surfaces
from mend.robots.vision.rectangle import fit_any, fit_sized
from mend.tasks.scene import Table

_EYE_M = 1.0
_BOX_M = 0.1


@cache
def warm_up() -> None:
    """Look at a made-up box: compiling amid a run would stop a robot for seconds, or for longer.

    What was compiled is kept on the machine, where some folder can be written.
    """
    table = Table(center=(0.0, 0.0), size=(1.0, 1.0), height=0.0)
    pose = np.diag([1.0, -1.0, -1.0, 1.0])
    pose[2, 3] = _EYE_M
    bgr = np.full((60, 80, 3), 200, np.uint8)
    depth_m = np.full(bgr.shape[:2], _EYE_M, np.float32)
    bgr[20:40, 30:50] = (30, 140, 20)
    depth_m[20:40, 30:50] -= _BOX_M
    heights = measure_heights(CameraImage(bgr, depth_m, pose, 100.0, (39.5, 29.5), 0.0), table)
    assert heights is not None, "the picture has depth"
    surfaces = find_surfaces(heights)
    for surface in surfaces.all:
        evidence = gather(surface, surfaces)
        fit_sized(evidence, [fit_any(evidence).rectangle])
