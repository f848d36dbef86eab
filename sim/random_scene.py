"""Random scenes: parts of every size, look and number, and a task tree that places all of them."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mend.errors import WrongInputError
from mend.robots.catalogue import Part
from mend.sim.random_nesting import random_ordered_nesting
from mend.sim.random_parts import DrawnSizes, PartLook, draw_look
from mend.sim.standing_room import RestingPart, standing
from mend.tasks.definition import BehaviorNode, GoalNode
from mend.tasks.scene import Place, Pose, Scene, Table
from mend.tasks.scene_problem import SceneProblem

MOST_PARTS = 30

SceneCheck = Callable[[Scene, Sequence[GoalNode | BehaviorNode]], list[SceneProblem]]
"""What a world's robot cannot do in a scene (`mend.sim.world.SceneChecker`)."""

_X_M = (0.40, 0.68)
_Y_M = (-0.62, 0.20)
_MIDDLE_Y_M = -0.22
_HIGHEST_M = 0.25
"""Stacks are at most so high."""
_EQUAL = 0.2
"""So many of all parts are equal to an earlier one."""
_ON_ANOTHER = 0.2
"""So many of all starts and places are on another part, where there is one for it."""
_SUPPORT_MARGIN_M = 0.010
"""The middle of a part is at least so far from the edge of what it stands on."""
_ROUNDING_M = 0.002
_OVERHANG = 1.5
"""A part is at most so many times as long as what it stands on."""
_POSES_TRIED = 60
_SHRINK = 0.7
_LOOKS_TRIED = 25
_ROOMY = 4
"""So many parts find room whatever their sizes; of more, more are small."""
_SCENES_TRIED = 40
_REPAIRS = 12


@dataclass(frozen=True, slots=True)
class RandomTask:
    """A scene, and the document of a task tree in the nested form that places all its parts."""

    scene: Scene
    tree: dict[str, Any]


@dataclass(frozen=True, slots=True)
class _Site:
    """Where a part starts or is to be: on the table, or on the part that it is `on`."""

    pose: Pose
    on: str | None
    room: RestingPart


@dataclass(frozen=True, slots=True)
class _Drawn:
    look: PartLook
    start: _Site
    place: _Site


def random_scene(
    seed: int,
    parts: int | None = None,
    check: SceneCheck | None = None,
    sizes: DrawnSizes | None = None,
) -> RandomTask:
    """A scene with so many parts, else with 1 to `MOST_PARTS`; the same for the same arguments.

    What `check` finds wrong is drawn anew. Raises `WrongInputError`.
    """
    if parts is not None and not 1 <= parts <= MOST_PARTS:
        raise ValueError(f"a random scene has 1 to {MOST_PARTS} parts, not {parts}")
    for attempt in range(_SCENES_TRIED):
        rng = np.random.default_rng([seed, attempt])
        count = parts or int(rng.integers(1, MOST_PARTS + 1))
        smallness = (1 + attempt / 4) * max(0, count - _ROOMY) / _ROOMY
        drawing = _Drawing(rng, sizes or DrawnSizes(), smallness)
        if drawing.fill(count) and _repair(drawing, seed, count, check):
            return RandomTask(drawing.scene(seed), drawing.tree(seed))
    asked_for = f"1 to {MOST_PARTS}" if parts is None else f"{parts}"
    raise WrongInputError(
        f"no scene with {asked_for} parts was found that a robot of this world can do: ask for "
        "fewer parts or another world"
    )


def _repair(drawing: "_Drawing", seed: int, count: int, check: SceneCheck | None) -> bool:
    """Draw anew what the check finds wrong, until it finds nothing."""
    if check is None:
        return True
    for _ in range(_REPAIRS):
        wrong = drawing.services_of(check(drawing.scene(seed), drawing.nodes(seed)))
        if not wrong:
            return True
        for name in wrong:
            drawing.take_away(name)
        if not drawing.fill(count):
            return False
    return False


class _Drawing:
    """A scene while it is drawn: every part has room at its start and at its place."""

    def __init__(self, rng: np.random.Generator, sizes: DrawnSizes, smallness: float) -> None:
        self._rng = rng
        self._sizes = sizes
        self._smallness = smallness
        self._table = Table()
        self._by_sides = rng.random() < 0.5
        """Whether all start on the right and go to the left; else everything is mixed."""
        self._parts: dict[str, _Drawn] = {}

    def fill(self, count: int) -> bool:
        """Draw parts until there are so many; False when one finds no room."""
        missing = [f"part_{n}" for n in range(1, count + 1) if f"part_{n}" not in self._parts]
        return all(self._add(name) for name in missing)

    def take_away(self, name: str) -> None:
        """Remove a part and all that stands or is to stand on it."""
        if self._parts.pop(name, None) is None:
            return
        for other, drawn in list(self._parts.items()):
            if name in (drawn.start.on, drawn.place.on):
                self.take_away(other)

    def services_of(self, problems: Sequence[SceneProblem]) -> list[str]:
        """The parts that problems speak of; all where one speaks of none."""
        named = [self._part_at(each.where) for each in problems]
        if any(name is None for name in named):
            return list(self._parts)
        return list(dict.fromkeys(name for name in named if name is not None))

    def _part_at(self, where: Sequence[str]) -> str | None:
        numbers = [each.partition("_")[2] for each in where]
        return next((f"part_{n}" for n in numbers if f"part_{n}" in self._parts), None)

    def scene(self, seed: int) -> Scene:
        parts = {name: self._parts[name] for name in self._names()}
        return Scene(
            name=f"random_{seed}",
            table=self._table,
            objects={name: each.look.at(each.start.pose) for name, each in parts.items()},
            places={_place_of(name): Place(pose=each.place.pose) for name, each in parts.items()},
        )

    def tree(self, seed: int) -> dict[str, Any]:
        rng = np.random.default_rng([seed, len(self._parts)])
        leaves = {name: _leaf(name) for name in self._names()}
        return {
            "name": f"random_{seed}",
            "scene": f"random_{seed}",
            "tree": random_ordered_nesting(rng, leaves, self._order()),
        }

    def nodes(self, seed: int) -> list[GoalNode | BehaviorNode]:
        """The nodes of the tree, depth first: what has to be done, and in which order."""
        found: list[GoalNode | BehaviorNode] = []

        def add(nested: dict[str, Any], parent: int | None) -> None:
            if "behavior" in nested:
                name, place = nested["object"], nested["place"]
                parameters = {"object": name, "place": place}
                found.append(
                    BehaviorNode(
                        parent=parent, name=name, behavior=nested["behavior"], parameters=parameters
                    )
                )
                return
            ((kind, children),) = nested.items()
            here = len(found)
            fields = {"kind": kind, "parent": parent, "name": f"goal_{here}"}
            found.append(GoalNode.model_validate(fields))
            for child in children:
                add(child, here)

        add(self.tree(seed)["tree"], None)
        return found

    def _names(self) -> list[str]:
        return sorted(self._parts, key=lambda name: int(name.partition("_")[2]))

    def _order(self) -> set[tuple[str, str]]:
        """Pairs of parts: the first has to be placed before the second one."""
        placed_on = {(each.place.on, name) for name, each in self._parts.items() if each.place.on}
        taken_from = {(name, each.start.on) for name, each in self._parts.items() if each.start.on}
        return {(first, then) for first, then in placed_on | taken_from if first and then}

    def _add(self, name: str) -> bool:
        """Draw a part, its start and its place; a smaller one where there is no room."""
        scale = float(self._rng.random()) ** self._smallness
        for _ in range(_LOOKS_TRIED):
            look = self._draw_look(scale)
            start = look and self._draw_site(name, look, is_start=True)
            if look and start:
                place = self._draw_site(name, look, is_start=False, beside=start)
                if place:
                    self._parts[name] = _Drawn(look, start, place)
                    return True
            scale *= _SHRINK
        return False

    def _draw_look(self, scale: float) -> PartLook | None:
        """An equal of an earlier part or one of a new kind; None if it looks too much like one."""
        earlier = [each.look for each in self._parts.values()]
        if earlier and self._rng.random() < _EQUAL:
            return earlier[int(self._rng.integers(len(earlier)))]
        look = draw_look(self._rng, self._sizes.scaled(scale), earlier)
        return None if any(_alike(look, each) for each in earlier) else look

    def _draw_site(
        self, name: str, look: PartLook, *, is_start: bool, beside: _Site | None = None
    ) -> _Site | None:
        """A start or place with room for a part; None if chance finds none."""
        taken = [
            (other, site)
            for other, drawn in self._parts.items()
            for site in (drawn.start, drawn.place)
        ]
        if beside is not None:
            taken.append((name, beside))
        below = self._supports(look, is_start=is_start, start_on=beside.on if beside else None)
        for _ in range(_POSES_TRIED):
            on = None
            if below and self._rng.random() < _ON_ANOTHER:
                on = below[int(self._rng.integers(len(below)))]
            site = self._site_on(on, look, is_start) if on else self._site_on_table(look, is_start)
            if site is None or not self._on_table(site, look):
                continue
            under = self._column(on, is_start) if on else []
            if not any(each.room.hinders(site.room) for _, each in taken if each not in under):
                return site
        return None

    def _supports(self, look: PartLook, *, is_start: bool, start_on: str | None) -> list[str]:
        """The parts that such a part may start on, or be placed on."""
        sites = {
            name: drawn.start if is_start else drawn.place for name, drawn in self._parts.items()
        }
        carrying = {site.on for site in sites.values()}
        return [
            name
            for name, drawn in self._parts.items()
            if drawn.look.knob is None
            and name not in carrying
            # What is lifted off a part before it is placed cannot go back onto it, directly or
            # by way of others.
            and (start_on is None or is_start)
            and min(drawn.look.size[:2]) > 2 * _SUPPORT_MARGIN_M
            and min(look.size[:2]) > _SUPPORT_MARGIN_M + _ROUNDING_M
            and max(look.size[:2]) <= _OVERHANG * min(drawn.look.size[:2])
            and self._top(sites[name], drawn.look) + look.height_m
            <= self._table.height + _HIGHEST_M
        ]

    def _column(self, on: str | None, is_start: bool) -> list[_Site]:
        """All that is below a part on `on`."""
        sites: list[_Site] = []
        while on is not None:
            drawn = self._parts[on]
            sites.append(drawn.start if is_start else drawn.place)
            on = sites[-1].on
        return sites

    def _top(self, site: _Site, look: PartLook) -> float:
        bottom = self._table.height if site.pose.z is None else site.pose.z
        return round(bottom + look.size[2], 4)

    def _site_on(self, on: str, look: PartLook, is_start: bool) -> _Site | None:
        drawn = self._parts[on]
        below = drawn.start if is_start else drawn.place
        half_x, half_y = (side / 2 - _SUPPORT_MARGIN_M for side in drawn.look.size[:2])
        # Over the middle rather than at the edge, so that towers do not lean.
        dx, dy = (float(self._rng.triangular(-half, 0.0, half)) for half in (half_x, half_y))
        cos, sin = math.cos(below.pose.yaw), math.sin(below.pose.yaw)
        pose = _pose(
            below.pose.x + cos * dx - sin * dy,
            below.pose.y + sin * dx + cos * dy,
            self._yaw(),
            self._top(below, drawn.look),
        )
        return _Site(pose, on, self._room(look, pose))

    def _site_on_table(self, look: PartLook, is_start: bool) -> _Site:
        low, high = _Y_M
        if self._by_sides:
            low, high = (low, _MIDDLE_Y_M) if is_start else (_MIDDLE_Y_M, high)
        pose = _pose(self._rng.uniform(*_X_M), self._rng.uniform(low, high), self._yaw(), None)
        return _Site(pose, None, self._room(look, pose))

    def _yaw(self) -> float:
        """Half of all parts stand straight, the others as they like."""
        return 0.0 if self._rng.random() < 0.5 else float(self._rng.uniform(-math.pi, math.pi))

    def _room(self, look: PartLook, pose: Pose) -> RestingPart:
        bottom = self._table.height if pose.z is None else pose.z
        return standing(Part("part", look.size, look.knob), pose.x, pose.y, bottom, pose.yaw)

    def _on_table(self, site: _Site, look: PartLook) -> bool:
        radius = math.hypot(*look.size[:2]) / 2
        return all(
            self._table.is_under(site.pose.x + dx, site.pose.y + dy)
            for dx in (-radius, radius)
            for dy in (-radius, radius)
        )


def _alike(look: PartLook, other: PartLook) -> bool:
    """Whether two parts of different kinds look almost the same."""
    color_m = max(abs(a - b) for a, b in zip(look.color, other.color, strict=True))
    size_m = max(abs(a - b) for a, b in zip(look.size, other.size, strict=True))
    return color_m < 0.15 and size_m < 0.012


def _leaf(name: str) -> dict[str, Any]:
    return {"behavior": "pick_and_place", "object": name, "place": _place_of(name)}


def _place_of(part: str) -> str:
    return f"place_{part.partition('_')[2]}"


def _pose(x: float, y: float, yaw: float, z: float | None) -> Pose:
    return Pose(x=round(float(x), 4), y=round(float(y), 4), z=z, yaw=round(yaw, 3))


def scene_document(scene: Scene) -> dict[str, Any]:
    """The document of a scene file, without what goes without saying."""
    return scene.model_dump(mode="json", exclude_defaults=True)
