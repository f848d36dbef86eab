"""The workcell: a PR2 at a table with parts, in PyBullet, with a person who intervenes."""

import numpy as np

from sim.workcell.bench import Bench
from sim.workcell.body import PERIOD_S, WorkcellBody
from sim.workcell.physics import connect
from sim.workcell.pr2 import Pr2
from tasks.scene import Scene

_GRAVITY_M_S2 = -9.81
_SOLVER_ITERATIONS = 50
_SETTLE_STEPS = 120


class WorkcellWorld:
    """A simulated world; the same seed and the same calls give the same world."""

    def __init__(self, scene: Scene, seed: int) -> None:
        self._rng = np.random.default_rng(seed)
        client = connect()
        self._client = client
        client.setPhysicsEngineParameter(
            fixedTimeStep=PERIOD_S, numSolverIterations=_SOLVER_ITERATIONS, enableFileCaching=0
        )
        client.setGravity(0.0, 0.0, _GRAVITY_M_S2)
        self.bench = Bench(client, scene)
        self.pr2 = Pr2(client)
        self.bench.lay_out(self._rng)
        self.body = WorkcellBody(self.pr2, {}, self._rng, self._step)
        for _ in range(_SETTLE_STEPS):
            self.body.advance_cycle()
        self.bench.remember_starts()
        self.body.cycle = 0

    def _step(self) -> None:
        self._client.stepSimulation()
