"""Events of a fleet and of the runs of its legs, for tests of its report."""

from datetime import UTC, datetime
from typing import Any
from uuid import UUID

from mend.fleet.requests import LegAction
from mend.robots.execution.phase import Phase
from mend.server.fleets.leg_task import LegStage, run_of
from mend.server.journal import events as ev

SITE = UUID(int=9)
FLEET: dict[str, Any] = {"wall_time": datetime(2026, 1, 2, tzinfo=UTC), "site": SITE}


def asked(
    name: str, status: str, at_s: float, kind: str = "transport", **what: Any
) -> ev.RequestChanged:
    """A request is so far."""
    described = {"kind": kind, "name": name, **what}
    more: dict[str, Any] = {"reason": None, "robot": None, "done_s": None}
    return ev.RequestChanged(
        at_s=at_s, request=name, what=described, status=status, **more, **FLEET
    )


class LegMaker:
    """The events of one leg of a robot."""

    def __init__(
        self, robot: str, number: int, booking: str, action: LegAction, to: str = "F1/102"
    ) -> None:
        self.leg: dict[str, Any] = {
            "robot": robot,
            "number": number,
            "booking": booking,
            "action": action,
            "place": to,
        }

    def begun(self, at_s: float, start: str = "F1/101") -> ev.LegBegun:
        return ev.LegBegun(at_s=at_s, start=start, **self.leg, **FLEET)

    def ended(self, at_s: float, outcome: str = "done", **more: Any) -> ev.LegEnded:
        at = {"reason": None, "at": self.leg["place"]}
        return ev.LegEnded(at_s=at_s, outcome=outcome, **at, **more, **self.leg, **FLEET)

    def run(self, stage: LegStage = LegStage.DO) -> "RunMaker":
        run = run_of(SITE, self.leg["robot"], self.leg["number"], stage)
        return RunMaker(run, self.leg["robot"])


class RunMaker:
    """The events of one run of a leg, by the run's clock."""

    def __init__(self, run: UUID, robot: str) -> None:
        self._run, self._robot = run, robot
        self._node: dict[str, Any] = {"node": "/", "name": "leaf", "robot": robot}
        self._execution = UUID(int=1)

    def _at(self, time: float) -> dict[str, Any]:
        return {"time": time, "wall_time": FLEET["wall_time"], "run": self._run}

    def started(self, time: float = 0.0) -> ev.RunStarted:
        return ev.RunStarted(
            tree_name="go",
            tree={},
            scene={},
            world="building",
            robots=[self._robot],
            seed=0,
            speed=1.0,
            scenario=None,
            options={},
            site=SITE,
            **self._at(time),
        )

    def set_out(self, time: float) -> ev.NodeStarted:
        return ev.NodeStarted(
            boot="b",
            execution=self._execution,
            attempt=1,
            candidates=[],
            **self._node,
            **self._at(time),
        )

    def step(self, time: float, phase: Phase | None) -> ev.StepStarted:
        return ev.StepStarted(
            execution=self._execution,
            step=1,
            step_name="step",
            phase=phase,
            **self._node,
            **self._at(time),
        )

    def raised(self, time: float, issue: str, *, interrupts: bool = True) -> ev.IssueRaised:
        return ev.IssueRaised(
            issue=issue,
            object=None,
            place=None,
            execution=self._execution,
            step=1,
            interrupts=interrupts,
            **self._node,
            **self._at(time),
        )

    def dialogue(
        self, begin: float, end: float, issue: str, number: int, *, helped: bool = True
    ) -> list[ev.Event]:
        about: dict[str, Any] = {
            **self._node,
            "dialogue": UUID(int=number),
            "issue": issue,
            "object": None,
        }
        resolved = ev.Resolved(resolution="robot_finish", helped=helped, **about, **self._at(end))
        return [ev.DialogueOpened(**about, **self._at(begin)), resolved]

    def resumed(self, time: float) -> ev.RobotResumed:
        return ev.RobotResumed(robot=self._robot, step=1, **self._at(time))

    def done(self, time: float) -> ev.NodeDone:
        return ev.NodeDone(by="robot", **self._node, **self._at(time))

    def finished(self, time: float) -> ev.RunFinished:
        return ev.RunFinished(missing=[], **self._at(time))

    def aborted(self, time: float) -> ev.RunAborted:
        return ev.RunAborted(reason="", **self._at(time))

    def lost(self, time: float) -> ev.RobotLost:
        return ev.RobotLost(robot=self._robot, reason="gone", **self._at(time))

    def back(self, time: float) -> ev.RobotBack:
        return ev.RobotBack(robot=self._robot, boot="b", continues=True, **self._at(time))
