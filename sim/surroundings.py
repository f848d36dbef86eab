"""What robots share in a simulated world: its clock, its people, and what it is rebuilt from."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any

from mend.documents.strict_model import StrictModel
from mend.robots.link.messages import Intervene, Intervened, ShownObject, ShownPose
from mend.robots.robot import Robot
from mend.robots.task_progress import TaskProgress
from mend.sim.interventions import HELPER, PendingInterventions, PendingSnapshot, PersonAction
from mend.sim.world import LeapingWorld, ShownWorld, World
from mend.tasks.intervention import Act, Intervention
from mend.tasks.scenario import ScriptedIntervention

_PUT_DOWN = (Act.PUT_BACK, Act.PLACE)
_LAST_STEP = 2**31


class SharedSnapshot(StrictModel):
    """A simulated world, how often each object was tried, and what people have still to do."""

    world: dict[str, Any]
    attempts: dict[str, int]
    pending: PendingSnapshot


class Surroundings:
    """A world and the people in it, as the robots in it have them.

    `told_at_once`: the service must see what was reported before more time passes. `tell` reports
    what people did as the robot that had asked for it, which nobody has for a scenario's.
    `shut_down`: no more time is to pass.
    """

    def __init__(
        self,
        world: World,
        robots: Sequence[Robot],
        interventions: Sequence[ScriptedIntervention],
    ) -> None:
        self.world = world
        self.tell: Callable[[str, Intervened], None] = lambda *_: None
        self.told_at_once = False
        self.shut_down = False
        self._robots = robots
        self._shown = world if isinstance(world, ShownWorld) else None
        self._leaping = world if isinstance(world, LeapingWorld) else None
        self._pending = PendingInterventions(interventions)
        self._attempts: dict[str, int] = {}
        self._earlier_attempts: dict[str, int] = {}

    def time_s(self) -> float:
        """The world's clock."""
        return self.world.time_s()

    def leap(self, until_s: float) -> None:
        """Skip cycles, that end before a time, in which neither the world nor anybody acts."""
        if self._leaping is not None:
            self._leaping.leap(min(until_s, self._pending.due_s))

    def snapshot(self) -> dict[str, Any]:
        """The state from which robots in the same scene can be rebuilt; JSON-compatible."""
        return {
            "world": self.world.snapshot(),
            "attempts": dict(self._attempts),
            "pending": self._pending.snapshot().model_dump(mode="json"),
        }

    def restore(self, snapshot: dict[str, Any]) -> None:
        """Raises `ValueError` for a snapshot that does not fit the world."""
        kept = SharedSnapshot.model_validate(snapshot)
        self.world.restore(kept.world)
        self._attempts = dict(kept.attempts)
        self._earlier_attempts = dict(kept.attempts)
        self._pending.restore(kept.pending)

    def shown_objects(self) -> Sequence[ShownObject] | None:
        """What there is, where the world shows it."""
        return None if self._shown is None else self._shown.shown_objects

    def shown_poses(self) -> Sequence[ShownPose] | None:
        """Where that really is."""
        return None if self._shown is None else self._shown.shown_poses()

    def count_attempts(self, progress: TaskProgress) -> TaskProgress:
        """A robot's progress, with the attempts of all robots counted, also of earlier ones."""
        name = progress.object
        if name is None:
            return progress
        # The robots' own counts begin anew when their process is started again.
        tried = sum(each.attempts.get(name, 0) for each in self._robots)
        self._attempts[name] = tried + self._earlier_attempts.get(name, 0)
        return replace(progress, attempt=self._attempts[name])

    # --- People -------------------------------------------------------------------------------

    @property
    def somebody_waits(self) -> bool:
        """Whether anybody has still something to do."""
        return self._pending.any_left

    def intervene_when_due(self, robot: str, command_id: str, command: Intervene) -> None:
        """Have a person do something for a robot, now or when the clock says so."""
        if command.at is None or command.at <= self.time_s():
            self._intervene(PersonAction(command.intervention, command.by, command_id, robot))
        else:
            self._pending.queue(robot, command_id, command, command.at)

    def withdraw(self, robot: str, handled: str | None) -> None:
        """Nobody still does for a robot what it has just said that it sees done."""
        self._pending.withdraw(robot, handled)

    def let_people_act(self, progresses: Iterable[TaskProgress | None]) -> None:
        """Let people do what is due at this moment."""
        for progress in progresses:
            for deed in self._pending.take_due(self.time_s(), progress):
                self._intervene(deed)

    def finish(self, progress: TaskProgress) -> None:
        """A robot is through with a behavior.

        The last moments of its last step are over before anybody can ask for them.
        """
        self.let_people_act([replace(progress, step=_LAST_STEP, fraction=1.0)])

    def _intervene(self, deed: PersonAction) -> None:
        if deed.by == HELPER and deed.do.act in _PUT_DOWN:
            # What somebody stands in front of would be put down in vain: the robot is to see it.
            step_aside = Intervention(act=Act.RELEASE)
            if not self.world.intervene(step_aside):
                self.tell(deed.robot, Intervened(intervention=step_aside, by=HELPER))
        problem = self.world.intervene(deed.do)
        report = Intervened(
            intervention=deed.do, by=deed.by, ok=not problem, detail=problem, command=deed.command
        )
        self.tell(deed.robot, report)
