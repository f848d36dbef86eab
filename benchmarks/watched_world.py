"""The simulated world of a run as it really was at each of its events, for those who judge."""

import math
from collections.abc import Sequence
from typing import Any

from dialogue_record import Moment
from untruths import Rest

from mend.server.journal import events as ev
from mend.server.journal.journal import Entry, Journal


class WatchedWorld:
    """Notes the state of a run's world beside every entry of the journal."""

    def __init__(self, journal: Journal) -> None:
        self.after: list[tuple[int, dict[str, Any]]] = []
        self._append = journal.append
        journal.append = self._watched  # type: ignore[method-assign]

    async def _watched(self, entry: Entry, *folded: Any, **named: Any) -> list[ev.Event]:
        committed = await self._append(entry, *folded, **named)
        if entry.world is not None:
            first = committed[0].seq if committed else self._last + 1
            self.after.append((first, dict(entry.world)))
        if committed:
            self._last = committed[-1].seq
        return committed

    _last = 0

    def moments(self, events: Sequence[ev.Event]) -> list[Moment]:
        """The world at each event: as the report said from which it follows, or the last one."""
        started = events[0]
        assert isinstance(started, ev.RunStarted), "a run begins with run_started"
        states, current = list(self.after), None
        moments = []
        for event in events:
            while states and states[0][0] <= event.seq:
                current = states.pop(0)[1]
            moments.append(_moment(started, current))
        return moments


def _moment(started: ev.RunStarted, state: dict[str, Any] | None) -> Moment:
    world = {} if state is None else state["world"]
    blocker = world.get("blocker_at") or world.get("obstacle") or world.get("blocker")
    return Moment(
        where_parts_rest(started, state),
        _held(world),
        blocker is not None,
        bool(world.get("head_covered")),
    )


def _held(world: dict[str, Any]) -> frozenset[str]:
    held = [world.get("held"), *world.get("also_held", ())]
    return frozenset(each for each in held if each is not None)


def where_parts_rest(
    started: ev.RunStarted, snapshot: dict[str, Any] | None
) -> dict[str, Rest | None]:
    """Where a simulated world's parts really are, from its last snapshot; None for gone ones."""
    objects = started.scene["objects"]
    world = {} if snapshot is None else snapshot["world"]
    if "parts" in world:
        return {
            name: None if part["stolen"] else _rest_of(part["rest"])
            for name, part in world["parts"].items()
        }
    height_m = started.scene["table"]["height"]
    resting: dict[str, Rest | None] = {}
    for name, each in objects.items():
        pose = each["pose"]
        start = (pose["x"], pose["y"], height_m if pose["z"] is None else pose["z"])
        x, y, z = world.get("moved", {}).get(name, start)[:3]
        resting[name] = None if name in world.get("gone", []) else Rest(x, y, z)
    return resting


def _rest_of(pose: dict[str, Any]) -> Rest:
    tilt_x, tilt_y, _, _ = pose["quaternion"]
    upright = 1.0 - 2.0 * (tilt_x**2 + tilt_y**2)
    return Rest(*pose["position"], lean_rad=math.acos(min(max(upright, -1.0), 1.0)))
