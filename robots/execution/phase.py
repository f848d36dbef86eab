"""The phases of a behavior, by which monitors name what they watch."""

from enum import StrEnum


class Phase(StrEnum):
    """What a step is for, in any behavior."""

    PREPARE = "prepare"
    """Before the first step: looking and planning."""
    TRAVEL = "travel"
    """The base drives."""
    RIDE = "ride"
    """The base waits for an elevator, or in it."""
    LOAD = "load"
    """The base waits until something is put into its basket."""
    UNLOAD = "unload"
    """The base waits until something is taken out of its basket."""
    TELL = "tell"
    """The base has told a message, and waits until somebody says that it was heard."""
    CHARGE = "charge"
    """The base stands at a charger."""
    APPROACH = "approach"
    GRASP = "grasp"
    LIFT = "lift"
    CARRY = "carry"
    PLACE = "place"
    RELEASE = "release"
    RETREAT = "retreat"
    CONFIRM = "confirm"
    """After the last step: looking whether the result is there."""
