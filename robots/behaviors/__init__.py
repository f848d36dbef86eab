"""What a robot can do: behaviors as lists of steps, and the execution that walks them."""

from robots.behaviors.behavior import Behavior, Move, SetGripper, Situation, Step
from robots.behaviors.phase import Phase

__all__ = ["Behavior", "Move", "Phase", "SetGripper", "Situation", "Step"]
