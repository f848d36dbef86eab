"""The colour model of a tabletop world."""

from mend.robots.vision.color_model import ColorModel
from mend.sim.color_lessons import Studio, teach_colors
from mend.sim.raster import Light
from mend.sim.tabletop.options import TabletopOptions
from mend.sim.tabletop.scenery import TABLE_COLOR
from mend.tasks.scene import Scene


def learn_colors(scene: Scene, options: TabletopOptions) -> ColorModel:
    """Learn the colours of all objects of a scene from pictures like the robot's own."""
    return teach_colors(scene, Studio(TABLE_COLOR, Light()), options.camera_noise)
