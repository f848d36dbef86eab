"""The colour model of a workcell."""

from mend.robots.vision.color_model import ColorModel
from mend.sim.color_lessons import Studio, teach_colors
from mend.sim.workcell.bench import TABLE_COLOR
from mend.sim.workcell.world import LIGHT
from mend.tasks.scene import Scene


def learn_colors(scene: Scene, camera_noise: float = 0.0) -> ColorModel:
    """Learn the colours of all objects of a scene from pictures like the robot's own."""
    return teach_colors(scene, Studio(TABLE_COLOR[:3], LIGHT), camera_noise)
