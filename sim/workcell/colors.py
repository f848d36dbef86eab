"""The colour model of a workcell, learned from pictures of its own parts in varying light."""

from functools import lru_cache

import numpy as np

from robots.vision.color_model import ColorModel, Sample
from sim.workcell.options import WorkcellOptions
from sim.workcell.world import WorkcellWorld
from tasks.scene import Scene

_LIGHTS = 3
_LEAST_PIXELS = 20


def learn_colors(scene: Scene, camera_noise: float = 0.0) -> ColorModel:
    """Learn the colours of all objects of a scene from head pictures.

    Raises `ColorModelError` for an object that is not coloured enough, or hidden.
    """
    return ColorModel.train(_take_samples(scene.model_dump_json(), camera_noise))


@lru_cache(maxsize=8)
def _take_samples(scene_json: str, camera_noise: float) -> dict[str, list[Sample]]:
    scene = Scene.model_validate_json(scene_json)
    samples: dict[str, list[Sample]] = {name: [] for name in scene.objects}
    for seed in range(_LIGHTS):
        options = WorkcellOptions(
            renderer="fast", camera_noise=camera_noise, light=1.0 if seed else 0.0
        )
        world = WorkcellWorld(scene, seed, options)
        image, rendering = world.head.capture_with_bodies()
        for name, part in world.parts.items():
            mask = (rendering.bodies == part.body_id).astype(np.uint8)
            if np.count_nonzero(mask) >= _LEAST_PIXELS:
                samples[name].append(Sample(image.bgr, mask))
        world.close()
    return samples
