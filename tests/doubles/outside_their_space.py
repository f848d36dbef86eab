"""Arms that are where they have no space: looked for in every control cycle of a tabletop."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any
from unittest.mock import patch

from shapely import Point

from mend.server.runtime.robot_proxy import RobotProxy
from mend.server.runtime.team import Team, held_by
from mend.sim.tabletop.state import TabletopState

_LEAST_M = 1e-6


@contextmanager
def outside_their_space() -> Iterator[list[str]]:
    """A sentence for each cycle in which an arm of the last run is outside the space that it has.

    Its robots are those of its scene, in that order.
    """
    outside: list[str] = []
    robots: list[RobotProxy] = []
    join, advance = Team.join, TabletopState.advance_cycle

    def joined(team: Team, proxies: Mapping[str, RobotProxy], **executing: Any) -> None:
        join(team, proxies, **executing)
        robots[:] = proxies.values()

    def watched(state: TabletopState) -> None:
        advance(state)
        for robot, manipulator in zip(robots, state.manipulators, strict=False):
            tool = manipulator.arm.pose
            if robot.room is None:
                continue
            off_m = held_by(robot).distance(Point(tool.x, tool.y))
            if off_m > _LEAST_M:
                outside.append(f"{robot.robot} is {off_m:.2f} m off at {state.time_s:.1f} s")

    with patch.object(Team, "join", joined), patch.object(TabletopState, "advance_cycle", watched):
        yield outside
