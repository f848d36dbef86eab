"""What the robots of a site have driven: read before and after, it says what was in between."""

from dataclasses import dataclass
from typing import Self

from mend.robots.link.messages import Driven


@dataclass(frozen=True, slots=True)
class Odometer:
    """What a base has driven since its program, `boot`, began."""

    boot: str
    driven: Driven

    def later(self, other: Self | None) -> Self:
        """This one, unless `other` is of the same program and has come farther."""
        if other is None or other.boot != self.boot or other.driven.way_m <= self.driven.way_m:
            return self
        return other

    def since(self, before: "Odometer | None") -> Driven | None:
        """What was driven since; None where its program has begun anew, or nothing is known."""
        if before is None or before.boot != self.boot:
            return None
        return Driven(
            way_m=max(0.0, self.driven.way_m - before.driven.way_m),
            barred_s=max(0.0, self.driven.barred_s - before.driven.barred_s),
        )
