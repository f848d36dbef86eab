"""What an arm can do: behaviors as lists of steps, and the execution that walks them."""

from mend.robots.arm.behaviors.behavior import ArmBehavior, Move, SetGripper, Situation, Step

__all__ = ["ArmBehavior", "Move", "SetGripper", "Situation", "Step"]
