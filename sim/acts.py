"""What a person beside the table does: how each act goes, whatever the world is made of."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from typing import Generic, Protocol, TypeVar

import numpy as np

from mend.sim.camera_cover import CameraCover
from mend.sim.free_pose import PLACE_RADIUS_M, radius_m
from mend.tasks.footprint import Footprint
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scene import Place, Pose, Scene

HAND_OVER_S = 15.0
"""How long somebody holds a part out to the robot."""

PULL_M_PER_S = 0.4

_SPOT_STEP_M = 0.05
_IN_THE_WAY_M = 0.008
"""What reaches less than this over the floor of a place is what the place stands on."""


class Impossible(Exception):  # noqa: N818 - an answer to the one who asked, not a failure
    """An intervention cannot be carried out; the message says why."""


class Handled(Protocol):
    """A part as a person handles it."""

    @property
    def name(self) -> str: ...


P = TypeVar("P", bound=Handled)
At = TypeVar("At")


class Acts(ABC, Generic[P, At]):
    """Everybody who is not the robot; a world says how parts (`P`) come to be at a pose (`At`)."""

    def __init__(self, scene: Scene, parts: Mapping[str, P]) -> None:
        self.head_cover = CameraCover()
        self._scene = scene
        self._parts = parts
        self._ways: dict[Act, Callable[[Intervention], None]] = {
            Act.STEAL: self._steal,
            Act.PUT_BACK: self._put_back,
            Act.PLACE: self._place,
            Act.HAND_OVER: self._hand_over,
            Act.MOVE: self._move,
            Act.BLOCK: self._block,
            Act.RELEASE: self._release,
            Act.COVER: self._cover,
            Act.UNCOVER: self._uncover,
        }

    def intervene(self, intervention: Intervention) -> str:
        """Start an intervention; an empty string, or one sentence that says why not."""
        way = self._ways.get(intervention.act)
        if way is None:
            return f"there is nothing at a table for which anybody could do '{intervention.act}'"
        try:
            way(intervention)
        except Impossible as reason:
            return str(reason)
        return ""

    # --- What a world adds --------------------------------------------------------------------

    @abstractmethod
    def hold_out(self, part: P, until_s: float) -> None:
        """Hold a part between the robot's fingers once they are open and at rest."""

    @abstractmethod
    def _now_s(self) -> float: ...

    @abstractmethod
    def _is_gone(self, part: P) -> bool:
        """Whether a part was taken away, or is just being pulled away."""

    @abstractmethod
    def _is_held(self, part: P) -> bool:
        """Whether the robot's fingers hold a part."""

    @abstractmethod
    def _offered(self) -> P | None:
        """The part that somebody is handing over."""

    @abstractmethod
    def _stands_in_the_way(self) -> bool: ...

    @abstractmethod
    def _stand_in_the_way(self) -> None:
        """Raises `Impossible` where there is no room."""

    @abstractmethod
    def _step_aside(self) -> None: ...

    @abstractmethod
    def _take_away(self, part: P, *, by_force: bool) -> None:
        """Let a part vanish, or pull it away `by_force`."""

    @abstractmethod
    def _take(self, part: P) -> None:
        """Let go of a part with whichever hand has it, so that something else can be done."""

    @abstractmethod
    def _start_of(self, part: P) -> At: ...

    @abstractmethod
    def _pose_at(self, pose: Pose) -> At: ...

    @abstractmethod
    def _put(self, part: P, at: At, where: str) -> None:
        """Put a part down, out of the robot's fingers if need be. May raise `Impossible`."""

    @abstractmethod
    def _footprint(self, part: P) -> Footprint | None:
        """The ground that a part covers that rests somewhere; None for any other."""

    @abstractmethod
    def _top_z(self, part: P) -> float: ...

    # --- Acts ---------------------------------------------------------------------------------

    def _steal(self, intervention: Intervention) -> None:
        part = self._part(intervention)
        if self._is_gone(part):
            raise Impossible(f"'{part.name}' is gone already")
        self._take_away(part, by_force=intervention.manner == "pull")

    def _put_back(self, intervention: Intervention) -> None:
        part = self._part(intervention)
        self._put(part, self._start_of(part), f"where '{part.name}' started")

    def _place(self, intervention: Intervention) -> None:
        part = self._part(intervention)
        if intervention.place is None:
            raise Impossible(f"it does not say at which place to put '{part.name}'")
        pose = self._place_of(intervention.place).pose
        self._put(part, self._pose_at(pose), f"at '{intervention.place}'")

    def _move(self, intervention: Intervention) -> None:
        part, to = self._part(intervention), intervention.to
        assert to is not None  # required by the act itself
        if not self._scene.table.is_under(to.x, to.y):
            raise Impossible(f"({to.x}, {to.y}) is not on the table")
        self._put(part, self._pose_at(to), f"at ({to.x}, {to.y})")

    def _hand_over(self, intervention: Intervention) -> None:
        part, offered = self._part(intervention), self._offered()
        if self._is_held(part):
            raise Impossible(f"the robot holds '{part.name}' already")
        if offered is not None and offered is not part:
            raise Impossible(f"somebody is handing over '{offered.name}' already")
        self._take(part)
        self.hold_out(part, self._now_s() + HAND_OVER_S)

    def _block(self, _: Intervention) -> None:
        if self._stands_in_the_way():
            raise Impossible("somebody stands in the way already")
        self._stand_in_the_way()

    def _release(self, intervention: Intervention) -> None:
        in_the_way = self._stands_in_the_way()
        if in_the_way:
            self._step_aside()
        lying = self._to_put_aside(intervention)
        for part in lying:
            self._put_aside(part, intervention)
        if not in_the_way and not lying:
            nothing = f" and '{intervention.place}' is free" if intervention.place else ""
            raise Impossible(f"nobody stands in the way{nothing}")

    def _cover(self, _: Intervention) -> None:
        if self.head_cover.on:
            raise Impossible("the head camera is covered already")
        self.head_cover.on = True

    def _uncover(self, _: Intervention) -> None:
        if not self.head_cover.on:
            raise Impossible("nothing covers the head camera")
        self.head_cover.on = False

    # --- How ----------------------------------------------------------------------------------

    def _part(self, intervention: Intervention) -> P:
        part = self._parts.get(intervention.object or "")
        if part is None:
            raise Impossible(f"the scene has no object '{intervention.object}'")
        return part

    def _place_of(self, name: str) -> Place:
        place = self._scene.places.get(name)
        if place is None:
            raise Impossible(f"the scene has no place '{name}'")
        return place

    def _to_put_aside(self, intervention: Intervention) -> list[P]:
        """The object itself; or, with a place for it, what lies on it or at that place."""
        if intervention.object is None:
            return []
        if intervention.place is None:
            return [self._part(intervention)]
        belongs = self._part(intervention)
        rooms = [self._room_at(intervention.place, belongs)]
        own = self._footprint(belongs)
        if own is not None:
            rooms.append((own, self._top_z(belongs)))
        return [
            part
            for part, covered in self._resting(belongs)
            if any(
                covered.overlaps(room) and self._top_z(part) > low_z + _IN_THE_WAY_M
                for room, low_z in rooms
            )
        ]

    def _room_at(self, place: str, belongs: P) -> tuple[Footprint, float]:
        """The ground that a part covers at a place, and its height."""
        pose = self._place_of(place).pose
        length, width, _ = self._scene.objects[belongs.name].size
        floor_z = self._scene.table.height if pose.z is None else pose.z
        return Footprint(pose.x, pose.y, pose.yaw, length, width), floor_z

    def _resting(self, but: P) -> Iterator[tuple[P, Footprint]]:
        for part in self._parts.values():
            covered = None if part is but else self._footprint(part)
            if covered is not None:
                yield part, covered

    def _put_aside(self, part: P, intervention: Intervention) -> None:
        """Put a part back to where it started, or else to the nearest free spot of the table.

        It goes neither to what is to be cleared nor where it is now.
        """
        others = [covered for each in self._parts.values() if (covered := self._footprint(each))]
        if intervention.place is not None:
            belongs = self._part(intervention)
            others.append(self._room_at(intervention.place, belongs)[0])
        radius = radius_m(part.name, self._scene)
        start = self._scene.objects[part.name].pose
        spots = [(spot, self._pose_at(spot)) for spot in _spots(self._scene, start, radius)]
        for spot, at in [(start, self._start_of(part)), *spots]:
            if not _is_free(spot, radius, others):
                continue
            try:
                self._put(part, at, "there")
            except Impossible:
                continue
            return
        raise Impossible(f"there is no room on the table to put '{part.name}' aside")


def _is_free(pose: Pose, radius: float, others: list[Footprint]) -> bool:
    return all(math.hypot(pose.x - o.x, pose.y - o.y) > radius + o.radius_m for o in others)


def _spots(scene: Scene, near: Pose, radius: float) -> list[Pose]:
    """Spots all over the table that belong to no place, the nearest first."""
    table = scene.table
    half_x, half_y = table.size[0] / 2 - radius, table.size[1] / 2 - radius
    spots = [
        Pose(x=table.center[0] + float(x), y=table.center[1] + float(y))
        for x in np.arange(-half_x, half_x + 1e-9, _SPOT_STEP_M)
        for y in np.arange(-half_y, half_y + 1e-9, _SPOT_STEP_M)
    ]
    clear_m = radius + PLACE_RADIUS_M
    places = [each.pose for each in scene.places.values()]
    free = [
        spot
        for spot in spots
        if all(math.hypot(spot.x - each.x, spot.y - each.y) > clear_m for each in places)
    ]
    return sorted(free, key=lambda spot: math.hypot(spot.x - near.x, spot.y - near.y))
