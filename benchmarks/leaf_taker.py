"""A person who does leaves of a run themselves, gives some back, and forgets others."""

import random
from collections.abc import Sequence
from typing import TYPE_CHECKING
from uuid import UUID

from untruths import paths_of

from mend.errors import RefusalError
from mend.server.journal import events as ev
from mend.tasks.definition import BehaviorNode, TaskTreeDefinition
from mend.tasks.intervention import Act, Intervention

if TYPE_CHECKING:
    from mend.server.composition import Service

_TAKES, _DOES, _GIVES_BACK = 0.4, 0.6, 0.2
"""How likely it is that they take a leaf when one is begun or done, and what becomes of it."""


class LeafTaker:
    """Whenever a leaf is begun or done they may take another one; by a seeded generator."""

    def __init__(self, service: "Service", run: UUID, rng: random.Random) -> None:
        self._service, self._run, self._rng = service, run, rng
        self.taken = 0
        """How many leaves they have had."""

    async def accompany(self) -> None:
        """Take leaves until cancelled."""
        leaves: Sequence[BehaviorNode] = ()
        paths: Sequence[str] = ()
        with self._service.journal.subscribe(0) as records:
            async for record in records:
                event = ev.any_event.validate_json(record.text)
                if isinstance(event, ev.RunStarted):
                    paths, leaves = _leaves(event)
                elif isinstance(event, ev.NodeStarted | ev.NodeDone):
                    await self._perhaps_take(paths, leaves)

    async def _perhaps_take(self, paths: Sequence[str], leaves: Sequence[BehaviorNode]) -> None:
        if self._rng.random() >= _TAKES:
            return
        number = self._rng.randrange(len(paths))
        node, leaf = paths[number], leaves[number]
        try:
            await self._service.runtime.take_leaf(self._run, node, "anna")
            self.taken += 1
            fate = self._rng.random()
            if fate < _DOES:
                deed = Intervention(act=Act.PLACE, object=leaf.object, place=leaf.place)
                await self._service.runtime.intervene(self._run, deed)
            elif fate < _DOES + _GIVES_BACK:
                await self._service.runtime.give_leaf_back(self._run, node, "anna")
        except RefusalError:
            # It is a robot's, or done, or not its turn; or the run has ended.
            return


def _leaves(started: ev.RunStarted) -> tuple[list[str], list[BehaviorNode]]:
    definition = TaskTreeDefinition.model_validate(started.tree)
    found = [
        (path, node)
        for path, node in zip(paths_of(definition), definition.nodes, strict=True)
        if isinstance(node, BehaviorNode)
    ]
    return [path for path, _ in found], [node for _, node in found]
