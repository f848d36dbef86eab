"""The table and the parts on it, as a scene says."""

from collections.abc import Callable, Iterable, Iterator, Mapping

import numpy as np

from mend.sim.workcell.parts import PartPose, RigidPart
from mend.sim.workcell.physics import LEAST_DISTANCE_M, Client
from mend.sim.workcell.pr2 import Pr2
from mend.tasks.scene import DRAWN_APART_M, Scene, Table

_FLOOR_HALF_M = 4.0
_SLAB_M = 0.04
_FLOOR_COLOR = (0.60, 0.60, 0.58, 1.0)
TABLE_COLOR = (0.80, 0.78, 0.74, 1.0)
_TABLE_FRICTION = 0.6

_SCATTER_TRIES = 100
_DROP_M = 0.001
"""Parts are let go this far above what they are to rest on."""

_OVERLAP_M = 0.001
"""Bodies that intersect by less than this only touch."""


class Bench:
    """Floor, table and parts."""

    def __init__(self, client: Client, scene: Scene) -> None:
        self._client = client
        self.scene = scene
        self.table_id = _create_table(client, scene.table)
        self.parts: Mapping[str, RigidPart] = {
            name: RigidPart(client, name, definition, number)
            for number, (name, definition) in enumerate(scene.objects.items())
        }
        # Last, as the engine's renderer draws in this order: of the floor, the largest thing in a
        # picture, only what nothing else hides is then coloured.
        _create_floor(client)

    def lay_out(self, rng: np.random.Generator) -> None:
        """Put every part to its start pose, scattered so that no two parts overlap."""
        for part in self.parts.values():
            part.take_away()
        for part in self.parts.values():
            for attempt in range(_SCATTER_TRIES + 1):
                scattered = attempt < _SCATTER_TRIES
                part.put(self._start_pose(part, rng if scattered else None))
                if next(self.intersecting(part, apart_m=DRAWN_APART_M), None) is None:
                    break

    def remember_starts(self) -> None:
        """Where the parts are now is where they start."""
        for part in self.parts.values():
            part.start = part.last_rest = part.pose()

    def intersecting(self, part: RigidPart, apart_m: float = -_OVERLAP_M) -> Iterator[RigidPart]:
        """The other parts that are nearer than `apart_m` to a part; below 0 they intersect."""
        for other in self.parts.values():
            if other is part or other.stolen:
                continue
            within_m = max(LEAST_DISTANCE_M, apart_m)
            points = self._client.getClosestPoints(part.body_id, other.body_id, within_m)
            if any(point[8] < apart_m for point in points):
                yield other

    def held(self, pr2: Pr2) -> RigidPart | None:
        """The part that both fingers touch."""
        for part in self.parts.values():
            if all(pr2.touched_by(part.body_id)):
                return part
        return None

    def remember_rests(self, robots: Iterable[Pr2], in_hand: Callable[[RigidPart], bool]) -> None:
        """Where parts lie still, touched by nobody, is where they last rested."""
        touched = set().union(*(each.touched() for each in robots))
        for part in self.parts.values():
            if part.body_id not in touched and not part.stolen and not in_hand(part):
                part.remember_rest()

    def _start_pose(self, part: RigidPart, rng: np.random.Generator | None) -> PartPose:
        pose, scatter = part.definition.pose, self.scene.scatter
        z = (self.scene.table.height if pose.z is None else pose.z) + _DROP_M
        if rng is None:
            return PartPose.upright(pose.x, pose.y, z, pose.yaw)
        dx, dy = rng.uniform(-scatter.xy, scatter.xy, 2)
        return PartPose.upright(
            pose.x + dx, pose.y + dy, z, pose.yaw + rng.uniform(-scatter.yaw, scatter.yaw)
        )


def _create_floor(client: Client) -> None:
    half = [_FLOOR_HALF_M, _FLOOR_HALF_M, _SLAB_M / 2]
    client.createMultiBody(
        0.0,
        client.createCollisionShape(client.GEOM_BOX, halfExtents=half),
        client.createVisualShape(client.GEOM_BOX, halfExtents=half, rgbaColor=_FLOOR_COLOR),
        [0.0, 0.0, -_SLAB_M / 2],
    )


def _create_table(client: Client, table: Table) -> int:
    """It looks like a slab but is solid down to the floor: nothing is ever pushed through it."""
    half_x, half_y, half_z = table.size[0] / 2, table.size[1] / 2, table.height / 2
    table_id: int = client.createMultiBody(
        0.0,
        client.createCollisionShape(client.GEOM_BOX, halfExtents=[half_x, half_y, half_z]),
        client.createVisualShape(
            client.GEOM_BOX,
            halfExtents=[half_x, half_y, _SLAB_M / 2],
            rgbaColor=TABLE_COLOR,
            visualFramePosition=[0.0, 0.0, half_z - _SLAB_M / 2],
        ),
        [*table.center, half_z],
    )
    client.changeDynamics(table_id, -1, lateralFriction=_TABLE_FRICTION)
    return table_id
