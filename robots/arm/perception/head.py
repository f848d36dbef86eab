"""What the head camera shows of the table: the parts, what is in the way, and what is missing."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from mend.robots.arm.body import ArmBody, ToolPose
from mend.robots.arm.perception.own_arm import OwnArm
from mend.robots.arm.perception.table_understanding import TableUnderstanding
from mend.robots.arm.result import JudgedResult
from mend.robots.body import CameraImage
from mend.robots.catalogue import Part
from mend.robots.link.messages import Location, Sighting
from mend.robots.vision.behind_others import BehindOthers
from mend.robots.vision.blindness import FROZEN, table_px, why_outdated
from mend.robots.vision.blob import Blob
from mend.robots.vision.carriers import unseen_carriers
from mend.robots.vision.freeze_detection import FreezeDetector
from mend.robots.vision.head import HeadSighting
from mend.robots.vision.height_map import measure_heights
from mend.robots.vision.obstruction import Clearance, Obstruction, corridor, find_obstruction
from mend.robots.vision.occupancy import Fit, find_occupant, room_above, room_at_place
from mend.robots.vision.presence import (
    Presence,
    is_at,
    is_seen_through,
    is_unmeasured,
    judge_presence,
    room_of,
    top_px,
)
from mend.robots.vision.projection import Points, project
from mend.robots.vision.seen_box import SeenBox
from mend.robots.vision.table_view import TableView

HEAD = "head"


class HeadSense:
    """The head camera, and what its pictures say of parts, places and ways."""

    def __init__(self, body: ArmBody, table: TableUnderstanding, own_arm: OwnArm) -> None:
        self._body = body
        self._table = table
        self._own_arm = own_arm
        self._catalogue = table.catalogue
        self._clearance = Clearance()
        self._fit = Fit()
        self._boxes: Sequence[SeenBox] = ()
        self._freeze = FreezeDetector()

    def look(self) -> CameraImage:
        """A head picture."""
        image = self._body.cameras[HEAD].capture()
        self._freeze.note(image, self._fingers())
        return image

    def glance(self) -> None:
        """Look at the arm where it is, so that a later picture without it is known to be new.

        Of a camera with noise that is known without.
        """
        if not self._freeze.knows_noise:
            self.look()

    def _fingers(self) -> Points:
        """Points (n, 3) of the fingers, where they are now."""
        tool = self._body.tool_pose()
        hulls = [np.empty((0, 3)), *self._body.finger_hulls()]
        return np.asarray(np.concatenate(hulls) @ tool[:3, :3].T + tool[:3, 3])

    def want(self, part: Part | None) -> None:
        """Of equal parts the one that is handled, or asked for, is what is brought back."""
        self._table.want(part)

    def doubt(self) -> None:
        """Understand the next head picture anew, even if nothing in it but noise has changed."""
        self._table.doubt()

    def why_blind(self, image: CameraImage, of: tuple[Part, Location] | None = None) -> str | None:
        """Why a head picture just taken tells nothing of the table, as a clause; or None.

        Or of the place `of` a part that is to be there, if it is seen nowhere else.
        """
        blind = why_outdated(image, self._body.time_s()) or self._table.why_blind(image)
        if blind is None and self._freeze.frozen:
            blind = FROZEN
        if blind is not None or of is None:
            return blind
        part, target = of
        room = room_of(part, target, self._catalogue.height_of(target))
        if self.sight(part, image) is not None or not is_unmeasured(image, room):
            return None
        return f"my head camera measures no depth where {part.name} is to be"

    def others_pass(
        self,
        behind: BehindOthers,
        image: CameraImage,
        of: tuple[Part, Location] | None = None,
    ) -> bool:
        """Whether robots that pass hide some of the table, or of a part's place, not for long."""
        if image.others is None:
            return False
        if of is None:
            return behind.will_show(image, table_px(image, self._catalogue.table))
        part, target = of
        room = room_of(part, target, self._catalogue.height_of(target))
        return behind.will_show(image, top_px(image, room))

    def sight(self, part: Part, image: CameraImage) -> HeadSighting | None:
        """Where a part is in a head picture; nowhere while it is held."""
        known = self._catalogue.parts.get(part.name) == part
        view = self._table.view(image, None if known else part)
        sighting = None if view is None else view.sightings.get(part.name)
        # What has not changed since an earlier picture is where it was, and seen now.
        return None if sighting is None else replace(sighting, time=image.time)

    def recall(self, part: Part, image: CameraImage) -> HeadSighting | None:
        """Where a part was when last seen, if something keeps the camera from seeing that."""
        view = self._table.view(image)
        stood = None if view is None else self._table.hidden_at(part, view)
        if stood is None:
            return None
        bottom_z = self._catalogue.height_of(stood)
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
        view = self._table.view(image)
        if view is None:
            return {}
        parts = self._catalogue.parts
        return {
            name: replace(each, time=image.time).to_message(parts[name])
            for name, each in view.sightings.items()
        }

    def seen_boxes(self, image: CameraImage) -> Sequence[SeenBox]:
        """Everything that a head picture shows on the table, known or not, and what carries it.

        Of one that shows no table, what the last one showed that did.
        """
        view = self._table.view(image)
        if view is not None:
            boxes = [*view.boxes, *view.recalled]
            carriers = unseen_carriers(boxes, self._catalogue.table.height)
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
        view = self._table.view(image)
        if view is None:
            return Presence.HIDDEN
        return judge_presence(
            view, part, self._table.equals_of(part), target, self._catalogue.height_of(target)
        )

    def understand(self, image: CameraImage) -> TableView | None:
        """What a head picture just taken shows of the table, past the arm; None if nothing."""
        return None if self.why_blind(image) is not None else self._table.view(image)

    def stood_at(self, view: TableView, part: Part, at: HeadSighting) -> Presence:
        """Whether a part, or one that looks the same, stood in an earlier view where it is now."""
        spot = Location(x=at.x, y=at.y, z=at.z, yaw=at.yaw)
        return judge_presence(view, part, self._table.equals_of(part), spot, at.z)

    def seen_gone(self, image: CameraImage, results: Iterable[JudgedResult]) -> list[JudgedResult]:
        """Of some results those whose part a picture shows, past the arm, not to be there."""
        heights = measure_heights(image, self._catalogue.table, self._own_arm.includes)
        if heights is None:
            return []
        height_of = self._catalogue.height_of
        return [
            each
            for each in results
            if is_seen_through(heights, room_of(each.part, each.target, height_of(each.target)))
        ]

    def recognize_at(self, image: CameraImage, part: Part, target: Location) -> bool:
        """Whether a part, or one that looks the same, stands at a place; then that is the part."""
        if self.presence(image, part, target) is not Presence.THERE:
            return False
        view = self._table.view(image)
        sighting = None if view is None else view.sightings.get(part.name)
        bottom_z = self._catalogue.height_of(target)
        if sighting is None or not is_at(sighting, part, target, bottom_z):
            at = target.x, target.y, bottom_z
            self._table.note_recognized(part.name, at)
        return True

    def obstruction(
        self, image: CameraImage, waypoints: Sequence[ToolPose], taking: Part | None = None
    ) -> Obstruction | None:
        """What stands in the way through `waypoints` that is no known part.

        It is no matter what the part that is to be taken stands on.
        """
        view = self._table.view(image)
        if view is None:
            return None
        name = None if taking is None else taking.name
        return self._table.in_the_way(
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
        view = self._table.view(image)
        if view is None:
            return None
        rooms = []
        if sighting is not None:
            rooms.append(room_above(part, sighting))
        if target is not None:
            rooms.append(room_at_place(part, target, self._catalogue.height_of(target)))
        found = (
            self._table.in_the_way(room, partial(find_occupant, view, room, self._fit))
            for room in rooms
        )
        return next((each for each in found if each is not None), None)
