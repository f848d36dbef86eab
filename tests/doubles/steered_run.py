"""A run without robots or a journal, whose events are folded at once: for drawing what happens."""

from collections.abc import Coroutine, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from random import Random
from types import SimpleNamespace
from typing import Any, cast
from uuid import UUID, uuid4

import numpy as np
from full_evaluation import Node, define

from mend.server.journal import events as ev
from mend.server.runtime.clock import SimulatedClock
from mend.server.runtime.context import RunContext, RunSettings
from mend.server.runtime.people import People
from mend.server.runtime.report_events import ReportEvents
from mend.server.runtime.run_state import RunState
from mend.server.runtime.steering import RunSteering
from mend.server.runtime.steering_views import AnySteering
from mend.server.runtime.team import Team
from mend.tasks.autonomy import AutonomyLevel
from mend.tasks.scene import Scene

RUN = UUID(int=7)
WALL_TIME = datetime(2026, 1, 2, tzinfo=UTC)
ROBOTS = ("left", "right")


def started(root: Node, needs: Sequence[AutonomyLevel], autonomy: AutonomyLevel) -> ev.RunStarted:
    """A run of a tree, in whose leaves somebody could see something done; `needs` in turn."""
    tree = define(root).to_json()
    leaves = [each for each in tree["nodes"] if each["kind"] == "behavior"]
    for number, leaf in enumerate(leaves):
        leaf["parameters"] = {"object": leaf["name"], "place": leaf["name"]}
        leaf["autonomy"] = str(needs[number % len(needs)])
    return ev.RunStarted(
        seq=1,
        time=0.0,
        wall_time=WALL_TIME,
        run=RUN,
        tree_name="random",
        tree=tree,
        scene=Scene(name="nothing", objects={}, places={}).model_dump(mode="json"),
        world="tabletop",
        robots=list(ROBOTS),
        seed=0,
        speed="max",
        scenario=None,
        options={"tree": "random", "autonomy": str(autonomy)},
    )


@dataclass
class SteeredRun:
    """Its events so far, and their fold."""

    first: ev.RunStarted
    events: list[ev.Event] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.state = RunState(self.first, {})
        self.clock = SimulatedClock(0.0)
        self.events = [self.first]
        self.settings = RunSettings()
        context = cast(RunContext, self)
        self.reports = ReportEvents(context, cast(Any, None))
        self.people = People(context, {}, self.reports, Team(self.state.scene, tuple))
        self.steering = RunSteering(context, self.reports, self.people)

    # --- As a run's context -------------------------------------------------------------------

    def stamp(self) -> dict[str, Any]:
        return {"time": self.clock.now(), "wall_time": WALL_TIME, "run": RUN}

    async def commit(self, events: Sequence[ev.Event]) -> None:
        for event in events:
            numbered = event.model_copy(update={"seq": len(self.events) + 1})
            self.events.append(numbered)
            self.state.fold(numbered)

    # --- What happens -------------------------------------------------------------------------

    def steer(self, wish: AnySteering) -> None:
        """Raises what the run would."""
        at_once(self.steering.steer(wish, "ann"))

    def happens(self, *events: ev.Event) -> None:
        at_once(self.commit(events))

    def startable(self) -> list[int]:
        """What a robot may begin by itself."""
        leaves = self.state.tree.eligible_leaves()
        held = self.state.steering.held_mask(leaves, self.state.taken_back)
        free = leaves[~held & ~np.isin(leaves, list(self.state.exhausted))]
        return [int(each) for each in free]

    def start(self, leaf: int, robot: str) -> None:
        self.happens(
            ev.NodeStarted(
                **self.stamp(),
                **self.reports.node(leaf),
                robot=robot,
                boot="boot",
                execution=uuid4(),
                attempt=self.state.tree.attempts(leaf) + 1,
                candidates=[],
            )
        )

    def finish(self, leaf: int) -> None:
        robot = self.state.tree.owner(leaf)
        self.happens(
            ev.NodeDone(**self.stamp(), **self.reports.node(leaf), robot=robot, by="robot")
        )

    def put_back(self, leaf: int, *, failed: bool) -> None:
        self.happens(self.reports.reset(leaf, None, "it slipped", failed=failed))

    def gone(self, leaf: int) -> None:
        """What a done leaf brought about is gone: what comes after it goes with it."""
        found = self.state.tree.what_to_take_back(leaf)
        for each in found.put_back:
            self.put_back(each, failed=False)
        for each in found.taken_back:
            because = None if each == leaf else self.state.tree.path_of(leaf)
            self.happens(
                ev.NodeUndone(
                    **self.stamp(),
                    **self.reports.node(each),
                    robot=ROBOTS[0],
                    reason="it is gone",
                    because_of=because,
                )
            )

    def give_up(self, leaf: int) -> bool:
        """Abandon the alternative that a leaf belongs to; False if there is none."""
        found = self.state.tree.give_up(leaf)
        if found is None:
            return False
        for each in found.put_back:
            self.put_back(each, failed=False)
        self.happens(
            ev.NodeAbandoned(
                **self.stamp(),
                **self.reports.node(found.alternative),
                leaf=self.state.tree.path_of(leaf),
                reason="it failed too often",
            )
        )
        return True

    def exhausted(self) -> list[int]:
        state = self.state
        return [leaf for leaf in sorted(state.exhausted) if state.tree.eligible(leaf)]

    def ends(self, random: Random) -> bool:
        """Let a robot go on alone, without a fault: whether the task is done or given up."""
        for _ in range(10 * len(self.state.tree)):
            for leaf in self.state.tree.active_leaves():
                self.finish(leaf)
            if self.state.tree.done(0):
                return True
            if (tired := self.exhausted()) and not self.give_up(tired[0]):
                return True
            if not tired:
                if not (startable := self.startable()):
                    return False
                self.start(random.choice(startable), ROBOTS[0])
        return False


def at_once(doing: Coroutine[Any, Any, None]) -> None:
    """Do what waits for nothing."""
    try:
        doing.send(None)
    except StopIteration:
        return
    raise AssertionError("it was to wait for nothing")


def fingerprint(state: RunState) -> SimpleNamespace:
    """What a state says of its tree and of how the run is steered."""
    tree, steering = state.tree, state.steering
    return SimpleNamespace(
        nodes=[
            (tree.active(i), tree.done(i), tree.abandoned(i), tree.owner(i), tree.attempts(i))
            for i in range(len(tree))
        ],
        breakpoints=dict(steering.breakpoints),
        let_go=set(steering.let_go),
        next=steering.next,
        level=steering.level,
        waiting=dict(steering.waiting),
        left_out=sorted(state.left_out),
        again=sorted(state.taken_back),
        exhausted=sorted(state.exhausted),
        seq=state.seq,
    )
