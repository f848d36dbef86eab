"""Steering of one run: what people say of its nodes, checked against the order of the tree."""

from mend.errors import ConflictError, RefusalError
from mend.server.journal import events as ev
from mend.server.runtime.context import RunContext
from mend.server.runtime.people import People
from mend.server.runtime.report_events import ReportEvents
from mend.server.runtime.run_state import RunState
from mend.server.runtime.steering_views import (
    AnySteering,
    NodeSteeringView,
    OfferedAct,
    RefusedAct,
    SetAutonomy,
    SteerNode,
)
from mend.tasks.definition import NodeKind
from mend.tasks.steering import Hold
from mend.tasks.steering_rules import Steered, SteeringAct, why_level_is_refused, why_refused

WORDS: dict[SteeringAct, type[ev.SteeringEvent]] = {
    SteeringAct.GO_ON: ev.LeafLetGo,
    SteeringAct.SET_BREAKPOINT: ev.BreakpointSet,
    SteeringAct.REMOVE_BREAKPOINT: ev.BreakpointRemoved,
    SteeringAct.DO_NEXT: ev.LeafPreferred,
    SteeringAct.NOT_NEXT: ev.LeafNotPreferred,
    SteeringAct.TRY_AGAIN: ev.LeafTriedAgain,
}
"""What is journaled of each act; of the others it is what is journaled of leaves."""


class RunSteering:
    """Takes what people say of one run, or says why it cannot be."""

    def __init__(self, context: RunContext, reports: ReportEvents, people: People) -> None:
        self._context = context
        self._reports = reports
        self._people = people

    async def steer(self, wish: AnySteering, by: str, author: ev.Author | None = None) -> None:
        """Do what somebody says. Raises `ConflictError` where it cannot be, or `NotFoundError`."""
        if isinstance(wish, SetAutonomy):
            await self._set_autonomy(wish, by, author)
            return
        tree = self._context.state.tree
        act, node = SteeringAct(wish.act), tree.index_of(wish.node)
        refused = why_refused(_steered(self._context), act, node)
        if refused is not None:
            raise ConflictError(refused)
        await self._do(act, node, wish, by, author)

    async def _do(
        self, act: SteeringAct, node: int, wish: SteerNode, by: str, author: ev.Author | None
    ) -> None:
        if act is SteeringAct.DONE_BY_HAND:
            await self._people.say_done(wish.node, by, wish.reason, author)
            return
        what = {**self._context.stamp(), **self._reports.node(node), "reason": wish.reason}
        if act is SteeringAct.LEAVE_OUT:
            event: ev.Event = ev.NodeLeftOut(**what, robot=None, helper=by, author=author)
        else:
            event = WORDS[act](**what, by=by, author=author)
        await self._context.commit([event])

    async def _set_autonomy(self, wish: SetAutonomy, by: str, author: ev.Author | None) -> None:
        refused = why_level_is_refused(self._context.state.steering, wish.level)
        if refused is not None:
            raise ConflictError(refused)
        said = ev.AutonomySet(
            **self._context.stamp(), level=wish.level, by=by, reason=wish.reason, author=author
        )
        await self._context.commit([said])

    def offers(self, node: str) -> NodeSteeringView:
        """What would be taken of a node now, and why the rest would not. Raises `NotFoundError`."""
        state = self._context.state
        index = state.tree.index_of(node)
        leaf = state.tree.kind_of(index) is NodeKind.BEHAVIOR
        offered, refused = [], []
        for act in SteeringAct:
            why = why_refused(_steered(self._context), act, index)
            if why is None and act is SteeringAct.DONE_BY_HAND:
                why = self._why_not_by_hand(node)
            if why is None:
                offered.append(OfferedAct(act=act, effect=effect_of(act, leaf=leaf)))
            else:
                refused.append(RefusedAct(act=act, why=why))
        return NodeSteeringView(
            run=state.id,
            node=node,
            name=state.tree.name_of(index),
            seq=state.seq,
            offered=offered,
            refused=refused,
        )

    def _why_not_by_hand(self, node: str) -> str | None:
        try:
            self._people.may_take(node)
        except RefusalError as error:
            return str(error)
        return None

    def held(self, hold: Hold, robot: str) -> ev.LeafHeld:
        """That a robot waits before a leaf."""
        state = self._context.state
        word = None if hold.breakpoint is None else state.steering.breakpoints[hold.breakpoint]
        return ev.LeafHeld(
            **self._context.stamp(),
            **self._reports.node(hold.leaf),
            robot=robot,
            breakpoint=None if hold.breakpoint is None else state.tree.path_of(hold.breakpoint),
            by=None if word is None else word.by,
            reason="" if word is None else word.reason,
            level=state.steering.level,
        )


def _steered(context: RunContext) -> Steered:
    return steered(context.state, context.settings.max_times_gone)


def steered(state: RunState, max_times_gone: int) -> Steered:
    """What of a run's state it depends on what may be said of its nodes."""
    too_often = {leaf for leaf, times in state.times_gone.items() if times > max_times_gone}
    return Steered(state.tree, state.steering, state.left_out, state.taken_back, too_often)


def effect_of(act: SteeringAct, *, leaf: bool) -> str:
    """What comes of something that is said of a node, in a sentence."""
    if act is SteeringAct.SET_BREAKPOINT and not leaf:
        return "The robots wait before the first leaf under it, until somebody lets them go on."
    return EFFECTS[act]


EFFECTS: dict[SteeringAct, str] = {
    SteeringAct.GO_ON: "It is begun this once. A breakpoint stays where it is.",
    SteeringAct.SET_BREAKPOINT: "The robots wait before it, until somebody lets them go on.",
    SteeringAct.REMOVE_BREAKPOINT: "Nobody waits before it any more.",
    SteeringAct.DO_NEXT: "The next robot that may begin it takes it before all others.",
    SteeringAct.NOT_NEXT: "The robots choose as ever.",
    SteeringAct.TRY_AGAIN: "It is to be done as if it were new, with all its attempts.",
    SteeringAct.LEAVE_OUT: "It counts as done without being there; the run says so at its end.",
    SteeringAct.DONE_BY_HAND: "A robot looks, and it is done once it is seen at its place.",
}
