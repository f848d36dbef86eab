"""All that one robot perceives, and what its head camera and its hand tell each other."""

from collections.abc import Sequence

from mend.robots.arm.body import ArmBody
from mend.robots.arm.grip.reading import GripReading
from mend.robots.arm.grip.watch import GripWatch
from mend.robots.arm.perception.hand import HandSense
from mend.robots.arm.perception.head import HeadSense
from mend.robots.arm.perception.own_arm import OwnArm
from mend.robots.arm.perception.table_understanding import TableUnderstanding
from mend.robots.catalogue import Catalogue
from mend.robots.vision.color_model import ColorModel
from mend.robots.vision.picture_memory import keep_picture_memory
from mend.robots.vision.seen_box import SeenBox


class Perception:
    """A body's cameras with the colour model that understands their pictures, and its hand."""

    def __init__(self, body: ArmBody, model: ColorModel, catalogue: Catalogue) -> None:
        keep_picture_memory()
        self.catalogue = catalogue
        self.hand = HandSense(body, model)
        own_arm = OwnArm(body, self.hand)
        self._table = TableUnderstanding(model, catalogue, self.hand, own_arm)
        self.head = HeadSense(body, self._table, own_arm)

    def let_go(self) -> None:
        """The fingers open: there is nothing to follow any more."""
        grip = self.hand.grip
        if grip is not None and not self.hand.has_askew:
            at = self.hand.position
            self._table.note(grip.part.name, (at.x, at.y, at.z - grip.grasp.height_m))
        self.hand.grip = None

    def read_grip(self) -> GripReading | None:
        """Take the hand as it is now into account; None if nothing is followed."""
        grip = self.hand.grip
        return None if grip is None else grip.update(self.hand.feel(self._around_hand()))

    def measure_grip(self, watch: GripWatch) -> GripReading:
        """Judge the hand by a watch without coming to a verdict."""
        return watch.measure(self.hand.feel(self._around_hand()))

    def _around_hand(self) -> Sequence[SeenBox]:
        """What the last head picture showed besides the part in the hand."""
        name = None if self.hand.grip is None else self.hand.grip.part.name
        return [each for each in self._table.last_boxes if each.name != name]
