"""What one robot perceives: its cameras' pictures, and what they show."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from robots.body import Body, CameraImage, ToolPose
from robots.catalogue import Catalogue, Part
from robots.clip import Clip
from robots.grasp import Grasp, grasp_of
from robots.grip.cues import CueModel
from robots.grip.reading import GripReading, GripState
from robots.grip.watch import GripWatch, Hand
from robots.link.messages import Location, Position, Sighting
from robots.result import Result
from robots.vision.blindness import why_blind, why_outdated
from robots.vision.blob import Blob
from robots.vision.carriers import unseen_carriers
from robots.vision.color_model import ColorModel
from robots.vision.head import HeadSighting
from robots.vision.height_map import measure_heights
from robots.vision.obstruction import (
    Clearance,
    Obstruction,
    corridor,
    find_obstruction,
    near,
)
from robots.vision.occupancy import Fit, Room, find_occupant, room_above, room_at_place
from robots.vision.presence import (
    Presence,
    is_at,
    is_seen_through,
    judge_presence,
    room_of,
)
from robots.vision.projection import Points, project
from robots.vision.scene_change import is_same, shows_change, still_measures
from robots.vision.seen_box import SeenBox
from robots.vision.table_view import TableView, boxes_of, view_table
from robots.vision.tracking import LastSeen

HEAD = "head"
FOREARM = "forearm"

_ARM_LENGTH_M = 0.7
"""How far the arm reaches back from the tool point, for telling it from an obstacle."""
_ARM_RADIUS_M = 0.16
_GRIPPER_RADIUS_M = 0.09
_BELOW_TOOL_M = 0.03
"""So far the fingers, or what they hold, may reach below the tool point."""


_Way = tuple[tuple[ToolPose, ...], str | None]
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
    in_the_way: dict[_Way | Room, Obstruction | None] = field(default_factory=dict)


class Senses:
    """A body's cameras with the colour model that understands their pictures.

    `grip` follows what is between the fingers, from when they closed on it until they open.
    """

    def __init__(
        self,
        body: Body,
        model: ColorModel,
        catalogue: Catalogue,
        cues: CueModel | None = None,
        clearance: Clearance | None = None,
        fit: Fit | None = None,
    ) -> None:
        self._body = body
        self._model = model
        self._cues = cues
        self._clearance = clearance or Clearance()
        self._fit = fit or Fit()
        self._seen: _Seen | None = None
        self._boxes: Sequence[SeenBox] = ()
        self._doubted = False
        self._wanted: str | None = None
        self._last_seen = LastSeen(catalogue.starts)
        self.catalogue = catalogue
        self.grip: GripWatch | None = None
        self.clip = Clip()

    @property
    def known_colors(self) -> tuple[str, ...]:
        """The objects that can be recognized."""
        return self._model.names

    @property
    def forearm_period_s(self) -> float:
        return self._body.cameras[FOREARM].period_s

    def look(self) -> CameraImage:
        """A head picture."""
        return self._body.cameras[HEAD].capture()

    def want(self, part: Part | None) -> None:
        """Of equal parts the one that is handled, or asked for, is what is brought back."""
        wanted = None if part is None or len(self._equals_of(part)) < 2 else part.name
        if wanted != self._wanted:
            self._wanted, self._seen = wanted, None

    def doubt(self) -> None:
        """Understand the next head picture anew, even if nothing in it but noise has changed."""
        self._doubted = True

    def why_blind(self, image: CameraImage) -> str | None:
        """Why a head picture just taken tells nothing of the table, as a clause; or None."""
        return why_outdated(image, self._body.time_s()) or self._take_in(image).blind

    def sight(self, part: Part, image: CameraImage) -> HeadSighting | None:
        """Where a part is in a head picture; nowhere while it is held."""
        known = self.catalogue.parts.get(part.name) == part
        view = self._understand(image, None if known else part)
        sighting = None if view is None else view.sightings.get(part.name)
        # What has not changed since an earlier picture is where it was, and seen now.
        return None if sighting is None else replace(sighting, time=image.time)

    def recall(self, part: Part, image: CameraImage) -> HeadSighting | None:
        """Where a part was when last seen whole, if something keeps the camera from seeing that."""
        view = self._understand(image)
        stood = None if view is None else self._hidden_at(part, view)
        if stood is None:
            return None
        bottom_z = self.catalogue.height_of(stood)
        at = stood.x, stood.y, bottom_z + part.size[2]
        u, v = project(image, np.array([at]))[0]
        nothing = np.zeros(image.bgr.shape[:2], np.uint8)
        return HeadSighting(
            x=stood.x,
            y=stood.y,
            z=bottom_z,
            yaw=stood.yaw,
            top_z=at[2],
            complete=False,
            shown=0.0,
            blob=Blob((float(u), float(v)), 0, (round(u), round(v), 1, 1), nothing),
            time=image.time,
        )

    def sight_all(self, image: CameraImage) -> dict[str, Sighting]:
        """Where every part of the catalogue is that a head picture shows."""
        view = self._understand(image)
        if view is None:
            return {}
        parts = self.catalogue.parts
        return {
            name: replace(each, time=image.time).to_message(parts[name])
            for name, each in view.sightings.items()
        }

    def seen_boxes(self, image: CameraImage) -> Sequence[SeenBox]:
        """Everything that a head picture shows on the table, known or not, and what carries it.

        Of one that shows no table, what the last one showed that did.
        """
        view = self._understand(image)
        if view is not None:
            boxes = [*view.boxes, *view.recalled]
            carriers = unseen_carriers(boxes, self.catalogue.table.height)
            self._boxes = [*boxes, *carriers]
        return self._boxes

    def shows_anything(
        self, image: CameraImage, at: tuple[float, float, float], but: Part | None = None
    ) -> bool:
        """Whether something other than a part stands around a point."""
        point = np.array([at])
        others = (each for each in self.seen_boxes(image) if but is None or each.name != but.name)
        return any(bool(each.holds(point)[0]) for each in others)

    def presence(self, image: CameraImage, part: Part, target: Location) -> Presence:
        """Whether a part, or one that looks the same, stands at a place."""
        view = self._understand(image)
        if view is None:
            return Presence.HIDDEN
        return judge_presence(
            view, part, self._equals_of(part), target, self.catalogue.height_of(target)
        )

    def seen_gone(self, image: CameraImage, results: Iterable[Result]) -> list[Result]:
        """Of some results those whose part a picture shows, past the arm, not to be there."""
        heights = measure_heights(image, self.catalogue.table, self._is_own_arm)
        if heights is None:
            return []
        height_of = self.catalogue.height_of
        return [
            each
            for each in results
            if is_seen_through(heights, room_of(each.part, each.target, height_of(each.target)))
        ]

    def recognize_at(self, image: CameraImage, part: Part, target: Location) -> bool:
        """Whether a part, or one that looks the same, stands at a place; then that is the part."""
        if self.presence(image, part, target) is not Presence.THERE:
            return False
        view = self._understand(image)
        sighting = None if view is None else view.sightings.get(part.name)
        if sighting is None or not is_at(sighting, target, self.catalogue.height_of(target)):
            at = target.x, target.y, self.catalogue.height_of(target)
            self._last_seen.note(part.name, at)
            self._seen = None
        return True

    def gripper(self) -> Position:
        """Where the tool point is."""
        x, y, z = (float(each) for each in self._body.tool_pose()[:3, 3])
        return Position(x=x, y=y, z=z)

    def new_watch(
        self, part: Part, grasp: Grasp | None = None, *, regrasp: bool = False
    ) -> GripWatch:
        """A grip watch that knows nothing yet; without `grasp`, for the best one."""
        gripper = self._body.gripper
        grasp = grasp or grasp_of(part, gripper)
        return GripWatch(part, grasp, self._model, gripper, self._cues, regrasp=regrasp)

    def watch_grip(self, part: Part, grasp: Grasp | None = None, *, regrasp: bool = False) -> None:
        """The fingers have closed on a part: follow it from now on.

        `regrasp`: where it is found askew it can be grasped anew.
        """
        self.grip = self.new_watch(part, grasp, regrasp=regrasp)

    def let_go(self) -> None:
        """The fingers open: there is nothing to follow any more."""
        if self.grip is not None and self.grip.state is not GripState.ASKEW:
            at = self.gripper()
            bottom_z = at.z - self.grip.grasp.height_m
            self._last_seen.note(self.grip.part.name, (at.x, at.y, bottom_z))
        self.grip = None

    def read_grip(self) -> GripReading | None:
        """Take the hand as it is now into account; None if nothing is followed."""
        if self.grip is None:
            return None
        return self.grip.update(self._hand())

    def measure_grip(self, watch: GripWatch) -> GripReading:
        """Judge the hand by a watch without coming to a verdict."""
        return watch.measure(self._hand())

    def film(self) -> None:
        """Take a forearm picture for the clip, if there is none yet of this moment."""
        if self.clip.due(self._body.time_s()):
            self._look_at_hand()

    def _hand(self) -> Hand:
        body = self._body
        return Hand(
            image=self._look_at_hand(),
            tool=body.tool_pose(),
            opening_m=body.gripper_opening_m(),
            effort_n=body.gripper_effort_n(),
            contact_n=body.contact_force_n(),
            fingers=body.finger_hulls(),
            around=self._last_seen_around(),
        )

    def _last_seen_around(self) -> Sequence[SeenBox]:
        """What the last head picture showed besides the part in the hand."""
        view = None if self._seen is None else self._seen.views.get(None)
        held = None if self.grip is None else self.grip.part.name
        return () if view is None else [each for each in view.boxes if each.name != held]

    def _look_at_hand(self) -> CameraImage:
        image = self._body.cameras[FOREARM].capture()
        self.clip.note(image)
        return image

    @property
    def has_askew(self) -> bool:
        """Whether something was pushed so that it has to be grasped anew."""
        return self.grip is not None and self.grip.state is GripState.ASKEW

    @property
    def held(self) -> str | None:
        """The part that was confirmed in the gripper and not lost since."""
        if self.grip is None or self.grip.state is not GripState.HELD:
            return None
        return self.grip.part.name

    def holds(self, name: str | None = None) -> bool:
        """Whether a part (`name`, or any) was confirmed in the gripper and not lost since."""
        held = self.held
        return held is not None and name in (None, held)

    def obstruction(
        self, image: CameraImage, waypoints: Sequence[ToolPose], taking: Part | None = None
    ) -> Obstruction | None:
        """What stands in the way through `waypoints` that is no known part.

        It is no matter what the part that is to be taken stands on.
        """
        view = self._understand(image)
        if view is None:
            return None
        name = None if taking is None else taking.name
        return self._in_the_way(
            (tuple(waypoints), name),
            partial(find_obstruction, view, corridor(waypoints), self._clearance, name),
        )

    def occupant(
        self,
        image: CameraImage,
        part: Part,
        sighting: HeadSighting | None,
        target: Location | None,
    ) -> Obstruction | None:
        """What lies on `part`, seen at `sighting`, or in the room that it needs at `target`."""
        view = self._understand(image)
        if view is None:
            return None
        rooms = []
        if sighting is not None:
            rooms.append(room_above(part, sighting))
        if target is not None:
            rooms.append(room_at_place(part, target, self.catalogue.height_of(target)))
        found = (
            self._in_the_way(room, partial(find_occupant, view, room, self._fit)) for room in rooms
        )
        return next((each for each in found if each is not None), None)

    def _in_the_way(
        self, where: _Way | Room, find: Callable[[], Obstruction | None]
    ) -> Obstruction | None:
        """What was found in a picture once is not searched for again while nothing changes."""
        if self._seen is None:
            return find()
        known = self._seen.in_the_way
        if where not in known:
            known[where] = find()
        return known[where]

    def _take_in(self, image: CameraImage) -> _Seen:
        """What is known of a head picture: all that was of an earlier one, if that still holds."""
        held, seen = self.held, self._seen
        doubted, self._doubted = self._doubted, False
        if seen is not None and seen.held == held and is_same(seen.latest, image):
            return seen
        blind = why_blind(image, self.catalogue.table, self._is_own_arm)
        if (
            seen is None
            or doubted
            or seen.held != held
            or seen.blind is not None
            or blind is not None
            or shows_change(seen.image, image)
            or not _still_measures_all(seen, image)
        ):
            self._seen = seen = _Seen(image, image, held, blind)
        seen.latest = image
        return seen

    def _understand(self, image: CameraImage, stranger: Part | None = None) -> TableView | None:
        """What a head picture shows; `stranger` is looked for besides the catalogue's parts.

        None for one that shows no table.
        """
        seen = self._take_in(image)
        if seen.blind is not None:
            return None
        if stranger not in seen.views:
            seen.views[stranger] = self._view(image, stranger)
        return seen.views[stranger]

    def _view(self, image: CameraImage, stranger: Part | None) -> TableView | None:
        parts = {name: part for name, part in self.catalogue.parts.items() if not self.holds(name)}
        if stranger is not None:
            parts[stranger.name] = stranger
        view = view_table(
            image,
            self.catalogue.table,
            parts,
            self._model,
            self._last_seen,
            self._is_own_arm,
            self._wanted,
        )
        if view is None:
            return None
        for name, each in view.sightings.items():
            self._last_seen.note_sighting(name, each)
        return replace(view, recalled=self._recalled(parts.values(), view))

    def _recalled(self, parts: Iterable[Part], view: TableView) -> list[SeenBox]:
        """What is not seen, but hidden where it was last seen whole."""
        found = []
        for part in parts:
            at = None if part.name in view.sightings else self._hidden_at(part, view)
            if at is not None:
                found += boxes_of(part, at, self.catalogue.height_of(at), complete=False)
        return found

    def _hidden_at(self, part: Part, view: TableView) -> Location | None:
        """Where a part was last seen whole, if something hides that now."""
        at = self._last_seen.seen_whole(part.name)
        if at is None:
            return None
        equals, bottom_z = self._equals_of(part), self.catalogue.height_of(at)
        presence = judge_presence(view, part, equals, at, bottom_z)
        if presence is Presence.GONE:
            self._last_seen.note_gone(part.name)
        return at if presence is Presence.HIDDEN else None

    def _is_own_arm(self, points: Points) -> NDArray[np.bool_]:
        """Which points are the arm: near the lines from the tool point back.

        One leads through its camera, one the way that the gripper came down.
        """
        pose = self._body.tool_pose()
        tool = pose[:3, 3]
        along = self._body.cameras[FOREARM].pose()[:3, 3] - tool
        back = tool + along / max(float(np.linalg.norm(along)), 1e-6) * _ARM_LENGTH_M
        above = tool - pose[:3, 0] * _ARM_LENGTH_M
        low_z = tool[2] - (_BELOW_TOOL_M if self.grip is None else self.grip.part.height)
        own: NDArray[np.bool_] = near(points, [(tool, back)], _ARM_RADIUS_M)
        own |= near(points, [(tool, above)], _GRIPPER_RADIUS_M)
        own &= points[:, 2] > low_z
        return own

    def _equals_of(self, part: Part) -> set[str]:
        """The names of all parts that look the same, its own among them."""
        return {part.name} | {
            name
            for name, other in self.catalogue.parts.items()
            if other.equals(part)
            and name in self._model.names
            and part.name in self._model.names
            and self._model.look_alike(name, part.name)
        }


def _still_measures_all(seen: _Seen, image: CameraImage) -> bool:
    """Whether a later picture measures whatever was recognized in an earlier one."""
    return all(
        still_measures(seen.image, image, each.blob.mask)
        for view in seen.views.values()
        if view is not None
        for each in view.sightings.values()
    )
