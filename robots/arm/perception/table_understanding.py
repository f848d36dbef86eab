"""What is understood of head pictures, and remembered while they show nothing else."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

from mend.robots.arm.body import ToolPose
from mend.robots.arm.perception.hand import HandSense
from mend.robots.arm.perception.own_arm import OwnArm
from mend.robots.body import CameraImage
from mend.robots.catalogue import Catalogue, Part
from mend.robots.link.messages import Location
from mend.robots.vision.blindness import why_blind, why_colorless, why_rough
from mend.robots.vision.color_model import ColorModel
from mend.robots.vision.obstruction import Obstruction
from mend.robots.vision.occupancy import Room
from mend.robots.vision.presence import Presence, judge_presence
from mend.robots.vision.scene_change import is_same, shows_change, still_measures
from mend.robots.vision.seen_box import SeenBox
from mend.robots.vision.table_view import TableView, boxes_of, view_table
from mend.robots.vision.tracking import LastSeen, Spot

Way = tuple[tuple[ToolPose, ...], str | None]
"""Waypoints of the tool point, and the name of the part that is to be taken there."""


@dataclass(slots=True)
class _Seen:
    """A head picture, and what was understood of it, by what else was looked for.

    It was taken while `held` was in the gripper. `blind` says why it shows nothing of the table.
    `in_the_way` is what was found on ways and in rooms. `latest` is the last picture that showed
    nothing else.
    """

    image: CameraImage
    latest: CameraImage
    held: str | None
    blind: str | None
    views: dict[Part | None, TableView | None] = field(default_factory=dict)
    in_the_way: dict[Way | Room, Obstruction | None] = field(default_factory=dict)


class TableUnderstanding:
    """Knows the catalogue's parts in head pictures, by their colours and where each was last."""

    def __init__(
        self, model: ColorModel, catalogue: Catalogue, hand: HandSense, own_arm: OwnArm
    ) -> None:
        self._model = model
        self._hand = hand
        self._own_arm = own_arm
        self._seen: _Seen | None = None
        self._doubted = False
        self._wanted: str | None = None
        self._last_seen = LastSeen(catalogue.starts)
        self.catalogue = catalogue

    @property
    def last_boxes(self) -> Iterable[SeenBox]:
        """What the last picture showed; nothing before it was understood."""
        view = None if self._seen is None else self._seen.views.get(None)
        return () if view is None else view.boxes

    def want(self, part: Part | None) -> None:
        """Of equal parts the one that is handled, or asked for, is what is brought back."""
        wanted = None if part is None or len(self.equals_of(part)) < 2 else part.name
        if wanted != self._wanted:
            self._wanted, self._seen = wanted, None

    def doubt(self) -> None:
        """Understand the next head picture anew, even if nothing in it but noise has changed."""
        self._doubted = True

    def note(self, name: str, at: Spot) -> None:
        """A part was brought to a place."""
        self._last_seen.note(name, at)

    def note_recognized(self, name: str, at: Spot) -> None:
        """What stands at a place is a part, whatever it was taken for."""
        self._last_seen.note(name, at)
        self._seen = None

    def why_blind(self, image: CameraImage) -> str | None:
        """Why a head picture tells nothing of the table, as a clause; or None."""
        return self._take_in(image).blind

    def view(self, image: CameraImage, stranger: Part | None = None) -> TableView | None:
        """What a head picture shows; `stranger` is looked for besides the catalogue's parts.

        None for one that shows no table.
        """
        seen = self._take_in(image)
        if seen.blind is not None:
            return None
        if stranger not in seen.views:
            seen.views[stranger] = self._view(image, stranger)
        return seen.views[stranger]

    def in_the_way(
        self, where: Way | Room, find: Callable[[], Obstruction | None]
    ) -> Obstruction | None:
        """What was found in a picture once is not searched for again while nothing changes."""
        if self._seen is None:
            return find()
        known = self._seen.in_the_way
        if where not in known:
            known[where] = find()
        return known[where]

    def hidden_at(self, part: Part, view: TableView) -> Location | None:
        """Where a part was last seen, be it in part, if something hides that now."""
        at = self._last_seen.seen_standing(part.name)
        if at is None:
            return None
        equals, bottom_z = self.equals_of(part), self.catalogue.height_of(at)
        presence = judge_presence(view, part, equals, at, bottom_z)
        if presence is Presence.GONE:
            self._last_seen.note_gone(part.name)
        return at if presence is Presence.HIDDEN else None

    def equals_of(self, part: Part) -> set[str]:
        """The names of all parts that look the same, its own among them."""
        return {part.name} | {
            name
            for name, other in self.catalogue.parts.items()
            if other.equals(part)
            and name in self._model.names
            and part.name in self._model.names
            and self._model.look_alike(name, part.name)
        }

    def _take_in(self, image: CameraImage) -> _Seen:
        """What is known of a head picture: all that was of an earlier one, if that still holds."""
        held, seen = self._hand.held, self._seen
        doubted, self._doubted = self._doubted, False
        # A doubted picture is understood anew, unless it is the very one that was understood.
        known = None if seen is None else seen.image if doubted else seen.latest
        if seen is not None and known is not None and seen.held == held and is_same(known, image):
            return seen
        blind = self._why_blind(image)
        if (
            seen is None
            or seen.held != held
            or seen.blind is not None
            or blind is not None
            or shows_change(seen.image, image)
            or doubted
            or not _still_measures_all(seen, image)
        ):
            self._seen = seen = _Seen(image, image, held, blind)
        seen.latest = image
        return seen

    def _why_blind(self, image: CameraImage) -> str | None:
        table, parts = self.catalogue.table, self.catalogue.parts
        blind = why_blind(image, table, self._own_arm.includes)
        if blind is not None:
            return blind
        lowest_m = min((part.size[2] for part in parts.values()), default=math.inf)
        hued = sum(self._model.has_hue(name) for name in parts if name in self._model.names)
        return why_rough(image, table, lowest_m) or (
            why_colorless(image, table, len(parts) - hued, self._own_arm.includes) if hued else None
        )

    def _view(self, image: CameraImage, stranger: Part | None) -> TableView | None:
        parts = {
            name: part for name, part in self.catalogue.parts.items() if not self._hand.holds(name)
        }
        if stranger is not None:
            parts[stranger.name] = stranger
        view = view_table(
            image,
            self.catalogue.table,
            parts,
            self._model,
            self._last_seen,
            self._own_arm.includes,
            self._wanted,
        )
        if view is None:
            return None
        for name, each in view.sightings.items():
            self._last_seen.note_sighting(name, each)
        return replace(view, recalled=self._recalled(parts.values(), view))

    def _recalled(self, parts: Iterable[Part], view: TableView) -> list[SeenBox]:
        """What is not seen, but hidden where it was last seen."""
        found = []
        for part in parts:
            at = None if part.name in view.sightings else self.hidden_at(part, view)
            if at is not None:
                found += boxes_of(part, at, self.catalogue.height_of(at), complete=False)
        return found


def _still_measures_all(seen: _Seen, image: CameraImage) -> bool:
    """Whether a later picture measures whatever was recognized in an earlier one."""
    return all(
        still_measures(seen.image, image, each.blob.mask)
        for view in seen.views.values()
        if view is not None
        for each in view.sightings.values()
    )
