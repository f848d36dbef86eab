"""What is between the fingers, by what the hand feels and by what its camera shows."""

from collections.abc import Iterable, Sequence

from mend.robots.arm.body import ArmBody
from mend.robots.arm.grasp import Grasp, grasp_of
from mend.robots.arm.grip.reading import GripState
from mend.robots.arm.grip.rivals import Rival, rivals_of
from mend.robots.arm.grip.watch import GripWatch, HandSnapshot
from mend.robots.body import CameraImage
from mend.robots.catalogue import Part
from mend.robots.clip import Clip
from mend.robots.link.messages import Position
from mend.robots.vision.color_model import ColorModel
from mend.robots.vision.seen_box import SeenBox

FOREARM = "forearm"


class HandSense:
    """The gripper and the forearm camera.

    `grip` follows what is between the fingers, from when they closed on it until they open; `clip`
    keeps the last pictures.
    """

    def __init__(self, body: ArmBody, model: ColorModel) -> None:
        self._body = body
        self._model = model
        self.grip: GripWatch | None = None
        self.clip = Clip()

    @property
    def period_s(self) -> float:
        """Between two pictures of the forearm camera."""
        return self._body.cameras[FOREARM].period_s

    @property
    def position(self) -> Position:
        """Where the tool point is."""
        x, y, z = (float(each) for each in self._body.tool_pose()[:3, 3])
        return Position(x=x, y=y, z=z)

    @property
    def has_askew(self) -> bool:
        """Whether what is between the fingers has to be let go of, and grasped anew."""
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

    def new_watch(
        self,
        part: Part,
        grasp: Grasp | None = None,
        *,
        regrasp: bool = False,
        rivals: Sequence[Rival] = (),
    ) -> GripWatch:
        """A grip watch that knows nothing yet; without `grasp`, for the best one."""
        gripper = self._body.gripper
        grasp = grasp or grasp_of(part, gripper)
        return GripWatch(part, grasp, self._model, gripper, regrasp=regrasp, rivals=rivals)

    def watch_grip(self, part: Part, grasp: Grasp | None = None, *, regrasp: bool = False) -> None:
        """The fingers have closed on a part: follow it from now on.

        `regrasp`: where it is found askew it can be grasped anew.
        """
        self.grip = self.new_watch(part, grasp, regrasp=regrasp)

    def watch_handed(self, part: Part, known: Iterable[Part]) -> None:
        """The fingers have closed on what a person put there, which may be any `known` part."""
        rivals = rivals_of(part, known, self._model, self._body.gripper)
        self.grip = self.new_watch(part, rivals=rivals)

    def feel(self, around: Sequence[SeenBox]) -> HandSnapshot:
        """The hand as it is now; `around` is what the head camera saw there last."""
        body = self._body
        return HandSnapshot(
            image=self._look(),
            tool=body.tool_pose(),
            opening_m=body.gripper_opening_m(),
            effort_n=body.gripper_effort_n(),
            contact_n=body.contact_force_n(),
            fingers=body.finger_hulls(),
            around=around,
        )

    def film(self) -> None:
        """Take a picture for the clip, if there is none yet of this moment."""
        if self.clip.due(self._body.time_s()):
            self._look()

    def _look(self) -> CameraImage:
        image = self._body.cameras[FOREARM].capture()
        self.clip.note(image)
        return image
