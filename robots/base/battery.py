"""The battery of a base, as its gauge tells."""

from typing import Protocol

LOW = 0.15
"""A base whose battery holds less of what it can sets out for nothing but a charger."""
ENOUGH = 0.8
"""Who was plugged in because its battery was low stays so until it holds as much."""
FULL = 0.95
"""Who charges is done then: the last of it takes long."""


class Battery(Protocol):
    """What a base drives on."""

    @property
    def endless(self) -> bool:
        """Whether it never runs out."""
        ...

    @property
    def share(self) -> float:
        """How much it holds of what it can, in [0, 1]."""
        ...

    @property
    def charging(self) -> bool:
        """Whether current comes in."""
        ...


class MainsPower:
    """Where a base never runs out."""

    endless = True
    share = 1.0
    charging = False
