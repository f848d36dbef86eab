"""The simulated person who keeps, more or less, what was promised in a dialogue."""

import numpy as np

from mend.server.journal import events as ev
from mend.server.runtime.context import RunContext
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.robot_proxy import RobotProxy
from mend.sim.interventions import HELPER
from mend.sim.person import Promise, deed
from mend.tasks.scenario import Person


class Promises:
    """The promises of one run; `person` is None where nobody is simulated."""

    def __init__(self, context: RunContext, person: Person | None) -> None:
        self._context = context
        self._person = person
        self._sent: set[str] = set()

    def forget(self) -> None:
        """The world was rebuilt: what a person was about to do has to be asked for again."""
        self._sent.clear()

    def have_kept(
        self, dialogue: DialogueState, awaiting: ev.HelpAwaited, proxy: RobotProxy
    ) -> None:
        """Let the simulated person keep a promise, as reliably as they are; once."""
        state, command = self._context.state, f"{dialogue.id}:{dialogue.helps}"
        known = command in self._sent or command in state.intervened
        if self._person is None or not self._person.acts or known:
            return
        self._sent.add(command)
        rng = np.random.default_rng([state.started.seed, state.helps])
        raised = dialogue.raised
        part = None if raised.detection is None else raised.detection.part
        in_the_way = part if part in state.scene.objects else None
        if raised.detection is not None and raised.detection.robot is not None:
            in_the_way = raised.detection.robot
        promise = Promise(
            str(awaiting.help),
            raised.item or raised.object,
            raised.place,
            in_the_way,
            proxy.robot,
        )
        finished = state.tree.finished_objects()
        # Nobody takes for the promised object what stands finished at its place.
        others = [name for name in state.scene.objects if name not in {raised.object, *finished}]
        done = deed(promise, self._person, state.scene, others, rng)
        if done is not None:
            at = self._context.clock.to_robot(awaiting.time + done.delay_s)
            proxy.intervene(command, done.intervention, HELPER, at)
