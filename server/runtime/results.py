"""The results of finished leaves: which are looked at, and what follows when one is gone."""

from collections.abc import Collection, Iterable

from mend.robots.link.messages import FinishedResult, Looked
from mend.server.journal import events as ev
from mend.server.runtime.context import RunContext
from mend.server.runtime.cutting_short import CuttingShort
from mend.server.runtime.report_events import ReportEvents
from mend.server.runtime.robot_proxy import RobotProxy
from mend.server.runtime.run_state import RunState


def results_of(state: RunState) -> dict[FinishedResult, int]:
    """What finished leaves left behind, and which leaf each is of.

    Where several leaves handle one object, in turn, the one that was started last says where it is
    to be. Nobody may change it.
    """
    if state.results is None:
        state.results = _results_of(state)
    return state.results


def _results_of(state: RunState) -> dict[FinishedResult, int]:
    results = {}
    for handled, leaf in state.last_handled.items():
        place = state.tree.leaf_definition(leaf).place
        if state.tree.done(leaf) and place is not None:
            results[FinishedResult(object=handled, place=place)] = leaf
    return results


def missing_parts(state: RunState) -> list[ev.MissingPart]:
    """What is not at its place because a helper said to go on without it."""
    return [_missing(state, leaf, event) for leaf, event in sorted(state.left_out.items())]


def _missing(state: RunState, leaf: int, left_out: ev.NodeLeftOut) -> ev.MissingPart:
    definition = state.tree.leaf_definition(leaf)
    return ev.MissingPart(
        node=left_out.node,
        name=left_out.name,
        object=definition.object or definition.entrusted or left_out.name,
        place=definition.place or left_out.name,
        left_out_by=left_out.helper,
        nowhere=definition.object is None,
    )


def unseen_parts(state: RunState, there: Collection[FinishedResult]) -> list[ev.UnseenPart]:
    """What is neither left out nor among the results that the last look saw."""
    tree = state.tree
    return [
        ev.UnseenPart(
            node=tree.path_of(leaf), name=tree.name_of(leaf), object=each.object, place=each.place
        )
        for each, leaf in results_of(state).items()
        if leaf not in state.left_out and each not in there
    ]


class Results:
    """Takes back what a robot sees gone, and notes what was left out and is seen again."""

    def __init__(
        self, context: RunContext, reports: ReportEvents, cutting_short: CuttingShort
    ) -> None:
        self._context = context
        self._reports = reports
        self._cutting_short = cutting_short

    async def judged(self, proxy: RobotProxy, looked: Looked) -> None:
        """Take what a look says of the results that it was to judge."""
        state = self._context.state
        results = results_of(state)
        there = (results[each] for each in looked.there if each in results)
        returned = [self._returned(leaf, proxy) for leaf in there if leaf in state.left_out]
        gone = [results[each] for each in looked.gone if each in results]
        gone = [leaf for leaf in gone if leaf not in state.left_out]
        if gone:
            await self._take_back(gone, proxy, returned)
        elif returned:
            await self._context.commit(returned)

    async def doubt_last(self, proxy: RobotProxy, blind: str) -> None:
        """Take back what was handled last: of a table that is not seen nobody can say it is done.

        The robot looks for it, and asks for its view.
        """
        results = results_of(self._context.state)
        seen = [leaf for leaf in results.values() if leaf not in self._context.state.left_out]
        if seen:
            await self._take_back(seen[-1:], proxy, (), blind)

    def _returned(self, leaf: int, proxy: RobotProxy) -> ev.NodeReturned:
        return ev.NodeReturned(
            **self._context.stamp(), **self._reports.node(leaf), robot=proxy.robot
        )

    async def _take_back(
        self,
        gone: Iterable[int],
        proxy: RobotProxy,
        before: Iterable[ev.Event],
        blind: str | None = None,
    ) -> None:
        tree = self._context.state.tree
        because: dict[int, int] = {leaf: leaf for leaf in gone}
        active: set[int] = set()
        for leaf in sorted(because):
            found = tree.what_to_take_back(leaf)
            for each in found.taken_back:
                because.setdefault(each, leaf)
            active.update(found.put_back)
        put_back = self._cutting_short.put_back(active, "what it comes after is no longer done")
        # What a THEN puts after another leaf is after it in the tree as well.
        undone = [
            self._undone(leaf, because[leaf], proxy, blind)
            for leaf in sorted(because, reverse=True)
        ]
        await self._cutting_short.commit(active, [*before, *put_back, *undone])

    def _undone(
        self, leaf: int, because_of: int, proxy: RobotProxy, blind: str | None
    ) -> ev.NodeUndone:
        tree = self._context.state.tree
        definition = tree.leaf_definition(leaf)
        follows = because_of != leaf
        why = f"{definition.object} is no longer at {definition.place}"
        if blind is not None:
            why = f"whether {definition.object} is at {definition.place} cannot be seen: {blind}"
        return ev.NodeUndone(
            **self._context.stamp(),
            **self._reports.node(leaf),
            robot=proxy.robot,
            reason=(
                f"it comes after {tree.name_of(because_of)}, which is no longer done"
                if follows
                else why
            ),
            because_of=tree.path_of(because_of) if follows else None,
            unseen=blind is not None and not follows,
        )
