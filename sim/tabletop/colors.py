"""The colour model of a tabletop world, learned from its own pictures when it starts."""

from functools import lru_cache

from robots.body import ToolPose
from robots.vision.color_model import ColorModel, ColorSettings, Histogram, Sample, learn
from sim.raster import Light
from sim.tabletop.world import TabletopOptions, TabletopWorld
from tasks.scene import Pose, Scene, SceneObject

_LIGHTS = (Light(), Light(direction=(-0.5, 0.4, 1.0), ambient=0.5, diffuse=0.45))
_YAWS_RAD = (0.0, 0.8)
_SIZE = (0.06, 0.06, 0.06)
_ABOVE_M = 0.10


def learn_colors(scene: Scene, options: TabletopOptions) -> ColorModel:
    """Learn the colours of all objects of a scene from pictures like the robot's own."""
    return ColorModel(
        {
            name: _learn_color(each.color, options.camera_noise)
            for name, each in scene.objects.items()
        },
        ColorSettings(),
    )


@lru_cache(maxsize=4096)
def _learn_color(color: tuple[float, float, float], noise: float) -> Histogram:
    """Scenes that are laid out share their colours, so one is learned but once."""
    return learn(f"a box of the colour {color}", _take_samples(color, noise), ColorSettings())


def _take_samples(color: tuple[float, float, float], noise: float) -> tuple[Sample, ...]:
    """Forearm pictures of a box of one colour on an empty table."""
    box = SceneObject(color=color, size=_SIZE, pose=Pose(x=0.5, y=0.0))
    scene = Scene(name="training", objects={"box": box}, places={})
    world = TabletopWorld(scene, 0, TabletopOptions(camera_noise=noise))
    samples = []
    for yaw in _YAWS_RAD:
        world.show_tool_at(ToolPose(0.5, 0.0, scene.table.height + _ABOVE_M, yaw))
        for light in _LIGHTS:
            image, ids = world.forearm.capture_with_ids(light)
            samples.append(Sample(image.bgr, (ids == 0).astype("uint8")))
    return tuple(samples)
