"""Everything that is so in a tabletop world at one moment, and what one control cycle changes."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from mend.robots.arm.body import ToolPose
from mend.sim.tabletop.blocker import SIZE_M, Blocker, on_the_way
from mend.sim.tabletop.manipulator import Manipulator
from mend.sim.tabletop.part import TablePart, UprightPose
from mend.sim.tabletop.resting import settle
from mend.tasks.frames import frames_of
from mend.tasks.scene import Scene

CONTROL_PERIOD_S = 0.1

_PASSES_M = 0.20
"""So far above the table the tool passes on most ways."""


class TabletopState:
    """The robots' arms, the parts, who stands in the way, and the clock."""

    def __init__(self, scene: Scene, rng: np.random.Generator) -> None:
        self.scene = scene
        self.time_s = 0.0
        self.parts: Mapping[str, TablePart] = {
            name: TablePart(name, definition, _start_pose(scene, name, rng))
            for name, definition in scene.objects.items()
        }
        self.manipulators: Sequence[Manipulator] = [
            Manipulator(frame, scene.table, self.parts) for frame in frames_of(scene).values()
        ]
        self.blocker: Blocker | None = None
        """Who stands in the way; an arm can always go up and home."""
        self.person_acts: Callable[[], None] = lambda: None
        """What people do in each cycle."""
        self.settle()

    def advance_cycle(self) -> None:
        """Let one control period pass."""
        self.time_s += CONTROL_PERIOD_S
        for each in self.manipulators:
            each.advance(CONTROL_PERIOD_S, self.blocker)
        self.person_acts()

    def reset(self, time_s: float, blocker: Blocker | None) -> None:
        """Start again, all arms at neutral with open, empty fingers (a rebuilt world)."""
        self.time_s = time_s
        self.blocker = blocker
        for each in self.manipulators:
            each.reset()

    def block_way(self) -> None:
        """Somebody stands where an arm, on its way or setting off from here, runs into them."""
        table = self.scene.table
        middle = ToolPose(*table.center, table.height + _PASSES_M, 0.0)
        arm = self._under_way().arm
        ways = (arm.way_ahead, [arm.pose, middle])
        found = (on_the_way(way, table.height) for way in ways)
        self.blocker = next(
            (each for each in found if each is not None),
            Blocker(*table.center, table.height + SIZE_M[2]),
        )

    def step_aside(self) -> None:
        """Nobody stands in any arm's way any more."""
        self.blocker = None
        for each in self.manipulators:
            each.touching = False

    def holder_of(self, part: TablePart) -> Manipulator | None:
        """Whose fingers hold a part."""
        return next((each for each in self.manipulators if each.held is part), None)

    def settle(self) -> None:
        """Let everything fall that nothing holds up any more."""
        settle(self.parts.values(), self.scene.table)

    def _under_way(self) -> Manipulator:
        """Whoever carries something, else whoever moves."""
        return max(self.manipulators, key=lambda each: (each.held is not None, each.arm.moving))


def _start_pose(scene: Scene, name: str, rng: np.random.Generator) -> UprightPose:
    """Where an object starts: where the scene says, give or take the scene's scatter."""
    pose, scatter = scene.objects[name].pose, scene.scatter
    dx, dy, turn = rng.uniform(-1.0, 1.0, 3)
    return UprightPose(
        pose.x + float(dx) * scatter.xy,
        pose.y + float(dy) * scatter.xy,
        scene.table.height if pose.z is None else pose.z,
        pose.yaw + float(turn) * scatter.yaw,
    )
