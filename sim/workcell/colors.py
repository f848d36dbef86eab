"""The colour model of a workcell."""

from robots.vision.color_model import ColorModel
from sim.color_lessons import Studio, teach_colors
from sim.workcell.bench import TABLE_COLOR
from sim.workcell.world import LIGHT
from tasks.scene import Scene


def learn_colors(scene: Scene, camera_noise: float = 0.0) -> ColorModel:
    """Learn the colours of all objects of a scene from pictures like the robot's own."""
    return teach_colors(scene, Studio(TABLE_COLOR[:3], LIGHT), camera_noise)
