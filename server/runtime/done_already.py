"""What follows once somebody has done another alternative than a robot is about to do."""

from mend.server.runtime.choosing import able_mask
from mend.server.runtime.cutting_short import CuttingShort
from mend.server.runtime.in_place import in_place_mask
from mend.server.runtime.parting import Parting, ancestors
from mend.server.runtime.robot_proxy import RobotProxy
from mend.server.runtime.run_state import RunState
from mend.tasks.definition import NodeKind


class DoneAlready:
    """Puts back what a robot has not begun to move yet once another alternative is seen done."""

    def __init__(self, state: RunState, cutting_short: CuttingShort) -> None:
        self._state = state
        self._cutting_short = cutting_short

    async def judged(self, proxy: RobotProxy) -> None:
        """Take what a robot has just seen: it then chooses anew, and finds that in place."""
        execution = self._state.executions.get(proxy.robot)
        if execution is None or not execution.held or execution.step:
            return
        if proxy.held is not None or proxy.blind is not None:
            return
        other = self._other_alternative(proxy, execution.leaf)
        if other is None:
            return
        done = self._state.tree.leaf_definition(other)
        reason = f"the {done.object} is at the {done.place} already, which does as well"
        leaves = [execution.leaf]
        put_back = self._cutting_short.put_back(leaves, reason, said=True)
        await self._cutting_short.commit(leaves, put_back)

    def _other_alternative(self, proxy: RobotProxy, leaf: int) -> int | None:
        """A leaf that would be done at once were this one put back, which it then need not be."""
        tree = self._state.tree
        if not any(tree.kind_of(each) is NodeKind.OR for each in ancestors(tree, leaf)):
            return None
        tree = tree.copy()
        tree.put_back(leaf, failed=False)
        leaves = tree.eligible_leaves()
        ready = in_place_mask(self._state, tree, proxy.seen, leaves)
        if ready[leaves == leaf].any():
            return None
        ready &= able_mask(self._state, proxy, leaves)
        parting = Parting(tree, leaf, leaves[ready])
        return next(iter(leaves[ready][parting.at_or].tolist()), None)
