"""What a look works with: a robot's arm and perception, and what they answer the service."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from mend.robots.arm.arm import Arm
from mend.robots.arm.behaviors.execution import ArmExecution
from mend.robots.arm.behaviors.search import LOOK_AGAIN_S, LOOKS
from mend.robots.arm.looks.shown import shown
from mend.robots.arm.perception import Perception
from mend.robots.arm.result import JudgedResult
from mend.robots.body import CameraImage
from mend.robots.execution.routine import Routine
from mend.robots.link.messages import Detection, FeltLoad, FinishedResult, Looked, ReportBody
from mend.robots.vision.behind_others import BehindOthers
from mend.robots.vision.presence import Presence


@dataclass(frozen=True, slots=True)
class Looker:
    """What a look works with, and answers.

    `held` is the execution that waits meanwhile. `may_move`: the arm may go to neutral to free the
    head camera's view. `finished`: the results that it is to judge.
    """

    arm: Arm
    perception: Perception
    report: Callable[[ReportBody], None]
    held: ArmExecution | None
    may_move: bool
    finished: Sequence[JudgedResult] = ()

    def feel_whether_it_is_held(self) -> Routine[None]:
        """Find out by fresh pictures of the hand whether what it held was taken away meanwhile."""
        hand = self.perception.hand
        for _ in range(LOOKS):
            if not hand.holds():
                return
            self.perception.read_grip()
            yield from self.arm.wait(hand.period_s)

    def free_view(self) -> Routine[None]:
        """Move the arm out of the head camera's view if that is allowed."""
        if self.may_move:
            yield from self.arm.go_to_neutral()

    def answer(
        self, command: str, fulfilled: bool | None, *, felt: FeltLoad | None = None
    ) -> Looked:
        """All that the head camera sees now; it judges no results."""
        looked = self._looked(command, fulfilled, self.perception.head.look(), {})
        return looked.model_copy(update={"felt": felt})

    def answer_and_judge(
        self,
        command: str,
        fulfilled: bool | None,
        detection: Callable[[CameraImage], Detection] | None = None,
    ) -> Routine[Looked]:
        """All that the head camera sees, and what became of the finished results.

        What seems gone, or a picture that shows no table, has to be so in a second picture as
        well: a hand may pass by. With the arm in view it judges none. The picture
        in which something was not found comes along, with its `detection`.
        """
        image = self.perception.head.look()
        results = self.finished if self.arm.at_rest else ()
        verdicts = self._judge(image, results)
        doubted = [each for each in results if verdicts[each.message] is Presence.GONE]
        blind = self._why_blind(image) is not None
        if doubted or blind:
            yield from self.arm.wait(LOOK_AGAIN_S)
            self.perception.head.doubt()
            image = self.perception.head.look()
            verdicts |= self._judge(image, results if blind else doubted)
        looked = self._looked(command, fulfilled, image, verdicts)
        if fulfilled is not False or detection is None:
            return looked
        return shown(looked, image, detection(image))

    def look_at_table(self) -> CameraImage | None:
        """A head picture; None if it shows nothing of the table."""
        image = self.perception.head.look()
        return image if self._why_blind(image) is None else None

    def others_pass(self, behind: BehindOthers) -> bool:
        """Whether robots that pass hide some of the table, not for long."""
        return self.perception.head.others_pass(behind, self.perception.head.look())

    def _why_blind(self, image: CameraImage) -> str | None:
        """Why a picture shows nothing of the table, or of where the one that waits put its part."""
        of = None if self.held is None else self.held.unconfirmed
        return self.perception.head.why_blind(image, of)

    def _judge(
        self, image: CameraImage, results: Sequence[JudgedResult]
    ) -> dict[FinishedResult, Presence]:
        if self._why_blind(image) is not None:
            return {each.message: Presence.HIDDEN for each in results}
        presence = self.perception.head.presence
        return {each.message: presence(image, each.part, each.target) for each in results}

    def _looked(
        self,
        command: str,
        fulfilled: bool | None,
        image: CameraImage,
        verdicts: Mapping[FinishedResult, Presence],
    ) -> Looked:
        blind = self._why_blind(image)
        return Looked(
            command=command,
            objects=self.perception.head.sight_all(image) if blind is None else {},
            gripper=self.perception.hand.position,
            fulfilled=fulfilled,
            there=[each for each, so in verdicts.items() if so is Presence.THERE],
            gone=[each for each, so in verdicts.items() if so is Presence.GONE],
            held=self.perception.hand.held,
            blind=blind,
            brought=None if blind is not None else self._brought(image),
        )

    def _brought(self, image: CameraImage) -> bool | None:
        """Of what the fingers of the execution that waits have lost."""
        if self.held is None or self.held.destination is None:
            return None
        seen = self.perception.head.sight(self.held.destination[0], image)
        return None if seen is None or seen.toppled else self.held.brought_to(seen)
