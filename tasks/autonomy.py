"""How much a robot may do without being asked: the levels of FlexBE, one for a run and for a leaf.

After Schillinger, Kohlbrecher and von Stryk 2016, whose transitions pass by themselves only where
they need less than the operator has allowed.
"""

from enum import StrEnum


class AutonomyLevel(StrEnum):
    """What a run allows, and what a leaf needs: a leaf begins by itself where it needs less."""

    OFF = "off"
    """Of a run: it asks before each leaf. Of a leaf: it needs nothing, as most leaves."""
    LOW = "low"
    """Of a run: it asks before recoveries, and before leaves that need as much."""
    HIGH = "high"
    """Of a run: it recovers by itself; it asks only before leaves that need as much."""
    FULL = "full"
    """Of a run: it does everything by itself. Of a leaf: it always asks."""

    @property
    def rank(self) -> int:
        """0 for `off` to 3 for `full`."""
        return _RANKS[self]

    def allows(self, needed: "AutonomyLevel") -> bool:
        """Whether a run of this level begins by itself what needs that one."""
        return needed.rank < self.rank


LEVELS = tuple(AutonomyLevel)
"""Each at its rank."""
_RANKS = {level: rank for rank, level in enumerate(LEVELS)}

RECOVERY = AutonomyLevel.LOW
"""What it needs at least to begin what has failed, or what was done and is gone."""
