"""Task allocation: what each idle robot of a run does next, as the tree's potentials have it."""

from uuid import uuid4

import numpy as np

from mend.robots.link.messages import Location, WasDone
from mend.server.journal import events as ev
from mend.server.runtime.choosing import able_mask, choose
from mend.server.runtime.context import RunContext
from mend.server.runtime.people import People
from mend.server.runtime.report_events import ReportEvents
from mend.server.runtime.results import Results, missing_parts, results_of, unseen_parts
from mend.server.runtime.robot_proxy import Purpose, RobotActivity, RobotProxy
from mend.server.runtime.run_state import StartedExecution
from mend.server.runtime.steering import RunSteering
from mend.server.runtime.team import Team


class TaskAllocation:
    """Gives idle robots of one run something to do: to resume, to begin, or to look a last time."""

    def __init__(
        self,
        context: RunContext,
        proxies: dict[str, RobotProxy],
        team: Team,
        people: People,
        reports: ReportEvents,
        results: Results,
        steering: RunSteering,
    ) -> None:
        self._context, self._proxies = context, proxies
        self._team, self._people = team, people
        self._reports, self._results = reports, results
        self._steering = steering
        self._looked_last: set[str] = set()
        """The robots that have looked since the task was done."""

    def looked_last(self, robot: str) -> None:
        """A robot has looked since the task was done."""
        self._looked_last.add(robot)

    def look_anew(self) -> None:
        """Who knows what was done meanwhile: who has looked looks again before the run ends."""
        self._looked_last.clear()

    async def occupy(self, proxy: RobotProxy) -> bool:
        """Give an idle robot something to do; True if that changed the state."""
        state = self._context.state
        execution = state.executions.get(proxy.robot)
        if execution is not None:
            if execution.held and self._may_resume(proxy, execution):
                leaf = state.tree.leaf_definition(execution.leaf)
                proxy.resume(execution, self._team.expected_at(proxy, leaf))
            elif execution.held and not proxy.looked_just_now(self._context.clock.now()):
                proxy.look(Purpose.RESUME)
            return False
        if proxy.holds_execution:
            proxy.retreat()
            return False
        if state.tree.done(0):
            return not state.executions and await self._look_last(proxy)
        self._looked_last.clear()
        return await self._start_something(proxy)

    def _may_resume(self, proxy: RobotProxy, execution: StartedExecution) -> bool:
        """Whether it has just looked, and has the space or can have it."""
        if not proxy.looked_just_now(self._context.clock.now()):
            return False
        leaf = self._context.state.tree.leaf_definition(execution.leaf)
        if not self._team.may_begin(proxy, leaf):
            return False
        self._team.take(proxy, leaf)
        return True

    async def _start_something(self, proxy: RobotProxy) -> bool:
        state = self._context.state
        choice = choose(state, proxy)
        if choice is None:
            if self._waits_for_a_word(proxy):
                return await self._wait_for_a_word(proxy)
            if proxy.area is not None:
                # Nothing that it could do is free: it is not to be in the way of others meanwhile.
                proxy.retreat()
            else:
                self._people.watch(proxy)
            return False
        if not proxy.looked_just_now(self._context.clock.now()):
            proxy.look(Purpose.CHOOSE)
            return False
        assert proxy.hello is not None, "a free robot has said hello"
        execution = StartedExecution(uuid4(), choice.leaf, proxy.robot, proxy.hello.boot)
        started = ev.NodeStarted(
            **self._context.stamp(),
            **self._reports.node(choice.leaf),
            robot=proxy.robot,
            boot=proxy.hello.boot,
            execution=execution.id,
            attempt=state.tree.attempts(choice.leaf) + 1,
            candidates=choice.candidates,
        )
        said = state.to_leave_out.get(choice.leaf)
        if said is not None:
            stamp = {**self._context.stamp(), "seq": 0, "robot": proxy.robot}
            await self._context.commit([started, said.model_copy(update=stamp)])
            return True
        await self._context.commit([started])
        self.start(proxy, execution)
        return True

    def _waits_for_a_word(self, proxy: RobotProxy) -> bool:
        """Whether it is to say that it waits before a leaf to be let go."""
        state = self._context.state
        told = np.array([each.leaf for each in state.held], dtype=np.int64)
        if able_mask(state, proxy, told).any():
            return False
        return choose(state, proxy, held=True) is not None

    async def _wait_for_a_word(self, proxy: RobotProxy) -> bool:
        """Say before which leaf it waits, once it has looked: it is the one that it would begin."""
        if not proxy.looked_just_now(self._context.clock.now()):
            proxy.look(Purpose.CHOOSE)
            return False
        state = self._context.state
        choice = choose(state, proxy, held=True)
        assert choice is not None, "it was found just now"
        hold = state.steering.hold_on(choice.leaf, state.taken_back)
        assert hold is not None, "only what is held was chosen from"
        await self._context.commit([self._steering.held(hold, proxy.robot)])
        return True

    def start(self, proxy: RobotProxy, execution: StartedExecution) -> None:
        """Have a robot do what the journal says that it has begun."""
        state = self._context.state
        taken_back = state.taken_back.get(execution.leaf)
        was_done: WasDone | None = None
        if taken_back is not None:
            gone = taken_back.because_of is None and not taken_back.unseen
            was_done = "gone" if gone else "there"
        tree, scene = state.tree, state.scene
        self._team.take(proxy, tree.leaf_definition(execution.leaf))
        part = scene.objects.get(tree.leaf_definition(execution.leaf).object or "")
        place = scene.places.get(tree.leaf_definition(execution.leaf).place or "")
        proxy.start(
            execution,
            node=tree.path_of(execution.leaf),
            behavior=tree.leaf_definition(execution.leaf).behavior,
            parameters=dict(tree.leaf_definition(execution.leaf).parameters),
            size=part.size if part else None,
            target=Location(**place.pose.model_dump()) if place else None,
            was_done=was_done,
            finished=[
                each for each, leaf in results_of(state).items() if leaf not in state.left_out
            ],
            object_at=self._team.expected_at(proxy, tree.leaf_definition(execution.leaf)),
        )

    async def _look_last(self, proxy: RobotProxy) -> bool:
        """Have every robot look that can, each at what it sees; True if that changed the state."""
        if proxy.robot not in self._looked_last:
            proxy.look(Purpose.LAST)
            return False
        looking = (each.doing is RobotActivity.LOOKING for each in self._proxies.values())
        if any(looking):
            return False
        await self._finish(proxy)
        return True

    async def _finish(self, proxy: RobotProxy) -> None:
        """End the run, unless of those who looked nobody has seen the table."""
        state = self._context.state
        looked = [each for each in self._proxies.values() if each.robot in self._looked_last]
        if proxy.blind is not None and all(each.blind is not None for each in looked):
            await self._results.doubt_last(proxy, proxy.blind)
        if not state.tree.done(0):
            return
        there = {each for other in self._proxies.values() for each in other.there}
        missing, unseen = missing_parts(state), unseen_parts(state, there)
        finished = ev.RunFinished(**self._context.stamp(), missing=missing, unseen=unseen)
        await self._context.commit([finished])
