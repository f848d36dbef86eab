"""What a robot can do: behaviors as lists of steps, and the execution that walks them."""

from mend.robots.arm.behaviors.behavior import Behavior, Move, SetGripper, Situation, Step
from mend.robots.arm.behaviors.phase import Phase

__all__ = ["Behavior", "Move", "Phase", "SetGripper", "Situation", "Step"]
