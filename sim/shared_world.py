"""A simulated world with robots in it: time passes for all of them at once."""

from collections.abc import Sequence
from typing import Any

from mend.robots.link.messages import Intervened
from mend.robots.robot import Robot
from mend.sim.simulated_agent import SimulatedAgent
from mend.sim.surroundings import Surroundings
from mend.sim.world import World, WorldSetup
from mend.tasks.scenario import ScriptedIntervention

_EPSILON_S = 1e-9


class SharedWorld:
    """An `AgentGroup`: robots in one world, and the people around them.

    A control cycle passes for all robots at a time, while any of them is busy.
    """

    def __init__(
        self,
        world: World,
        robots: Sequence[Robot],
        *,
        speed: float | None,
        interventions: Sequence[ScriptedIntervention] = (),
        snapshot: dict[str, Any] | None = None,
    ) -> None:
        """`speed`: simulated seconds per second, None as fast as possible.

        Raises `ValueError` for a snapshot that does not fit the world.
        """
        self._robots = list(robots)
        self._surroundings = Surroundings(world, self._robots, interventions)
        self._agents = [SimulatedAgent(each, self._surroundings) for each in self._robots]
        self._by_name = {each.name: each for each in self._agents}
        self._surroundings.tell = self._tell
        self._speed = speed
        if snapshot is not None:
            self._surroundings.restore(snapshot)

    @classmethod
    def of(cls, setup: WorldSetup, world: World, robots: Sequence[Robot]) -> "SharedWorld":
        """One as it is told at its start. Raises `ValueError` for a snapshot that does not fit."""
        return cls(
            world,
            robots,
            speed=setup.speed,
            interventions=setup.interventions,
            snapshot=setup.snapshot,
        )

    @property
    def world(self) -> World:
        """The world as it really is; for tests and benchmarks to judge by."""
        return self._surroundings.world

    def _tell(self, robot: str, done: Intervened) -> None:
        """Report what people did once, as the robot that it was for, else as one that is busy.

        What a robot with a task tells is told in that.
        """
        busy = (agent for agent, its in zip(self._agents, self._robots, strict=True) if its.busy)
        self._by_name.get(robot, next(busy, self._agents[0])).report(done)

    @property
    def agents(self) -> Sequence[SimulatedAgent]:
        return self._agents

    @property
    def pace(self) -> float | None:
        """Simulated seconds per wall second wanted now: of the slowest that any robot wants."""
        wanted = [each.pace(self._speed) for each in self._agents if each.busy] or [self._speed]
        return min((each for each in wanted if each is not None), default=None)

    def time_s(self) -> float:
        """The world's clock."""
        return self._surroundings.time_s()

    @property
    def shut_down(self) -> bool:
        """Whether a `shutdown` command came."""
        return self._surroundings.shut_down

    def snapshot(self) -> dict[str, Any]:
        """The state from which robots in the same scene can be rebuilt; JSON-compatible."""
        return self._surroundings.snapshot()

    def advance(self, duration_s: float) -> bool:
        """Let up to `duration_s` of the clock pass; False when there is nothing to do."""
        end_s = self.time_s() + duration_s
        self._surroundings.told_at_once = False
        while not self._surroundings.told_at_once and not self.shut_down:
            self._let_people_act()
            ended = [each.end_hold() for each in self._agents]
            if any(ended):
                break
            if not self._busy or self.time_s() >= end_s - _EPSILON_S:
                break
            self._let_cycle_pass(end_s)
        return self._busy

    @property
    def _busy(self) -> bool:
        return not self.shut_down and any(each.busy for each in self._agents)

    def _let_people_act(self) -> None:
        if self._surroundings.somebody_waits:
            self._surroundings.let_people_act([each.note_progress() for each in self._agents])

    def _let_cycle_pass(self, end_s: float) -> None:
        """One control cycle at most, so that people act in the very cycle that is theirs.

        Those before it in which nothing happens at all, because robots only wait, pass at once.
        """
        for robot in self._robots:
            robot.begin_slice()
            robot.decide()
        waits = any(each.holds for each in self._agents)
        active = any(each.active for each in self._robots)
        if self._surroundings.told_at_once or not (waits or active):
            return
        if not active:
            self._surroundings.leap(min(end_s, *(each.holds_until_s for each in self._agents)))
        self._surroundings.world.advance_cycle()
        for robot in self._robots:
            robot.end_cycle()
            robot.decide()
