"""The courtyard as it really is: carts, a lamp post in the middle, and visitors now and then."""

import math
from collections.abc import Iterable
from typing import Any

from courtyard.cart import PERIOD_S, RADIUS_M, Cart
from courtyard.floor import Circle
from mend.robots.base.body import BasePose
from mend.tasks.frames import Frame
from mend.tasks.intervention import Act, Intervention

POST: Circle = (0.0, 0.0, 0.2)
_VISITOR_RADIUS_M = 0.25
_VISITORS = 8


class Courtyard:
    """Implements `mend.sim.world.World`."""

    def __init__(self, frames: Iterable[Frame]) -> None:
        self._time_s = 0.0
        self.visitors: list[Circle] = []
        self.carts = [Cart(each, self.time_s, self.around, self.advance_cycle) for each in frames]

    def time_s(self) -> float:
        return self._time_s

    def advance_cycle(self) -> None:
        self._time_s += PERIOD_S
        for each in self.carts:
            each.advance()

    def around(self, cart: Cart) -> list[Circle]:
        """All that a cart's laser may see but for the walls."""
        carts = [(e.place.x, e.place.y, RADIUS_M) for e in self.carts if e is not cart]
        return [POST, *carts, *self.visitors]

    # --- People -------------------------------------------------------------------------------

    def intervene(self, intervention: Intervention) -> str:
        """Visitors gather round the first cart that drives, or go away."""
        match intervention.act:
            case Act.BLOCK:
                driving = next((each for each in self.carts if each.moving), None)
                if driving is None:
                    return "nobody stands in the way of carts that stand"
                at, away_m = driving.place, RADIUS_M + _VISITOR_RADIUS_M + 0.5
                bearings = [at.yaw + math.tau * each / _VISITORS for each in range(_VISITORS)]
                self.visitors = [
                    (at.x + away_m * math.cos(b), at.y + away_m * math.sin(b), _VISITOR_RADIUS_M)
                    for b in bearings
                ]
                return ""
            case Act.RELEASE:
                self.visitors = []
                return ""
            case act:
                return f"there is nothing in a courtyard for which anybody could do '{act}'"

    # --- What it is rebuilt from ----------------------------------------------------------------

    def snapshot(self) -> dict[str, Any]:
        carts = [[each.place.x, each.place.y, each.place.yaw] for each in self.carts]
        return {"time_s": self._time_s, "carts": carts, "visitors": self.visitors}

    def restore(self, snapshot: dict[str, Any]) -> None:
        if len(snapshot["carts"]) != len(self.carts):
            raise ValueError(f"expected {len(self.carts)} carts, got {len(snapshot['carts'])}")
        self._time_s = snapshot["time_s"]
        self.visitors = [(x, y, radius) for x, y, radius in snapshot["visitors"]]
        for cart, place in zip(self.carts, snapshot["carts"], strict=True):
            cart.jump(BasePose(*place))

    def close(self) -> None:
        """Nothing is open."""
