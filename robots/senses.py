"""What one robot perceives: its cameras' pictures, and what they show."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from robots.body import Body, CameraImage, ToolPose
from robots.catalogue import Catalogue, Part
from robots.clip import Clip
from robots.grasp import Grasp, grasp_of
from robots.link.messages import Location, Position, Sighting
from robots.vision.color_model import ColorModel, Segmentation
from robots.vision.forearm import GripReading, GripState, GripTolerances, GripWatch
from robots.vision.head import HeadSighting, locate
from robots.vision.obstruction import (
    Clearance,
    Obstruction,
    Segment,
    corridor,
    find_obstruction,
)
from robots.vision.occupancy import Fit, find_occupant, room_above, room_at_place
from robots.vision.presence import Presence, is_at
from robots.vision.seen_box import SeenBox

HEAD = "head"
FOREARM = "forearm"

_ARM_LENGTH_M = 0.7
"""How far the arm reaches back from the tool point, for telling it from an obstacle."""


@dataclass(slots=True)
class _Seen:
    """The last head picture, and what was found in it so far."""

    image: CameraImage
    segmentation: Segmentation
    sightings: dict[Part, HeadSighting | None] = field(default_factory=dict)


class Senses:
    """A body's cameras with the colour model that understands their pictures.

    `grip` follows what is between the fingers, from when they closed on it until they open.
    """

    def __init__(
        self,
        body: Body,
        model: ColorModel,
        catalogue: Catalogue,
        tolerances: GripTolerances | None = None,
        clearance: Clearance | None = None,
        fit: Fit | None = None,
    ) -> None:
        self._body = body
        self._model = model
        self._tolerances = tolerances
        self._clearance = clearance or Clearance()
        self._fit = fit or Fit()
        self._seen: _Seen | None = None
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

    def sight(self, part: Part, image: CameraImage) -> HeadSighting | None:
        """Where a part is in a head picture."""
        seen = self._understand(image)
        if part not in seen.sightings:
            seen.sightings[part] = locate(image, seen.segmentation, part)
        return seen.sightings[part]

    def sight_all(self, image: CameraImage) -> dict[str, Sighting]:
        """Where every part of the catalogue is that a head picture shows."""
        seen = {}
        for name, part in self.catalogue.parts.items():
            sighting = self.sight(part, image) if name in self._model.names else None
            if sighting is not None:
                seen[name] = sighting.to_message(part)
        return seen

    def seen_boxes(self, image: CameraImage) -> Sequence[SeenBox]:
        """Everything that a head picture shows on the table."""
        boxes = []
        for name in self.catalogue.parts.keys() & set(self._model.names):
            part = self.catalogue.parts[name]
            seen = self.sight(part, image)
            if seen is None:
                continue
            height_m = part.size[2] + (part.knob[2] if part.knob else 0.0)
            size = (part.size[0], part.size[1], height_m)
            boxes.append(SeenBox(seen.x, seen.y, seen.yaw, size, seen.z, name, seen.complete))
        return boxes

    def presence(self, image: CameraImage, part: Part, target: Location) -> Presence:
        """Whether a head picture shows a part at its place."""
        sighting = self.sight(part, image)
        if sighting is not None and is_at(sighting, target, self.catalogue.height_of(target)):
            return Presence.THERE
        room = room_at_place(part, target, self.catalogue.height_of(target))
        segmentation = self._understand(image).segmentation
        hidden = find_occupant(image, segmentation, room, (), self._clearance, self._fit)
        return Presence.GONE if hidden is None else Presence.HIDDEN

    def gripper(self) -> Position:
        """Where the tool point is."""
        x, y, z = (float(each) for each in self._body.tool_pose()[:3, 3])
        return Position(x=x, y=y, z=z)

    def new_watch(self, part: Part, grasp: Grasp | None = None) -> GripWatch:
        """A grip watch that knows nothing yet; without `grasp`, for the best one."""
        grasp = grasp or grasp_of(part, self._body.gripper)
        return GripWatch(part, grasp, self._model, self._tolerances, self.forearm_period_s)

    def watch_grip(self, part: Part, grasp: Grasp | None = None) -> None:
        """The fingers have closed on a part: follow it from now on."""
        self.grip = self.new_watch(part, grasp)

    def let_go(self) -> None:
        """The fingers open: there is nothing to follow any more."""
        self.grip = None

    def read_grip(self) -> GripReading | None:
        """Take a forearm picture into account; None if nothing is followed."""
        if self.grip is None:
            return None
        image = self._look_at_hand()
        return self.grip.update(image, self._body.tool_pose(), self._body.gripper_opening_m())

    def measure_grip(self, watch: GripWatch) -> GripReading:
        """Judge a forearm picture by a watch without coming to a verdict."""
        image = self._look_at_hand()
        return watch.measure(image, self._body.tool_pose(), self._body.gripper_opening_m())

    def film(self) -> None:
        """Take a forearm picture for the clip, if there is none yet of this moment."""
        if self.clip.due(self._body.time_s()):
            self._look_at_hand()

    def _look_at_hand(self) -> CameraImage:
        image = self._body.cameras[FOREARM].capture()
        self.clip.note(image)
        return image

    def holds(self, name: str | None = None) -> bool:
        """Whether a part (`name`, or any) was confirmed in the gripper and not lost since."""
        return (
            self.grip is not None
            and self.grip.state is GripState.HELD
            and name in (None, self.grip.part.name)
        )

    def obstruction(
        self, image: CameraImage, waypoints: Sequence[ToolPose], arm_is_away: bool
    ) -> Obstruction | None:
        """What stands in the way through `waypoints` that is no known part."""
        return find_obstruction(
            image,
            self._understand(image).segmentation,
            corridor(waypoints),
            () if arm_is_away else (self._own_arm(),),
            self.catalogue.table.height,
            self._clearance,
        )

    def occupant(
        self,
        image: CameraImage,
        part: Part,
        sighting: HeadSighting | None,
        target: Location | None,
        arm_is_away: bool,
    ) -> Obstruction | None:
        """What lies on `part`, seen at `sighting`, or in the room that it needs at `target`."""
        rooms = []
        if sighting is not None:
            rooms.append(room_above(part, sighting))
        if target is not None:
            rooms.append(room_at_place(part, target, self.catalogue.height_of(target)))
        arm = () if arm_is_away else (self._own_arm(),)
        segmentation = self._understand(image).segmentation
        found = (
            find_occupant(image, segmentation, room, arm, self._clearance, self._fit)
            for room in rooms
        )
        return next((each for each in found if each is not None), None)

    def _own_arm(self) -> Segment:
        """From the tool point back through the forearm camera, which is mounted on the arm."""
        tool = self._body.tool_pose()[:3, 3]
        along = self._body.cameras[FOREARM].pose()[:3, 3] - tool
        return tool, tool + along / max(float(np.linalg.norm(along)), 1e-6) * _ARM_LENGTH_M

    def _understand(self, image: CameraImage) -> _Seen:
        if self._seen is None or self._seen.image is not image:
            self._seen = _Seen(image, self._model.segment(image.bgr))
        return self._seen
