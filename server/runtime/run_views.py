"""From a run's state to what clients see of it."""

import asyncio
from collections.abc import AsyncIterator, Sequence
from typing import Literal, cast

from pydantic import TypeAdapter

from mend.robots.link.messages import Hello
from mend.server.journal.journal import JournalReadError
from mend.server.journal.run_index import UNREADABLE, IndexedRun
from mend.server.journal.stored_event import read_event
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.run_result import Ending, result_of
from mend.server.runtime.run_state import RunState
from mend.server.runtime.steering_views import BreakpointView, PreferredView, SteeringView
from mend.server.runtime.views import (
    AwaitedHelp,
    DialogueView,
    NodeView,
    PromptView,
    RobotView,
    RunResult,
    RunStatus,
    RunSummary,
    RunView,
    UnseenHelpView,
    WaitView,
)
from mend.server.turns import Turns
from mend.tasks.activation import FullEvaluation
from mend.tasks.steering import Hold


def summary(state: RunState, time: float, trouble: str | None) -> RunSummary:
    """One line about a run; `trouble`: why the journal cannot be written, if it cannot."""
    started = state.started
    return RunSummary(
        id=started.run,
        tree=started.tree_name,
        world=started.world,
        scenario=started.scenario,
        seed=started.seed,
        speed=started.speed,
        status=state.status,
        time=time,
        started=started.wall_time,
        ended=state.ended,
        robots=started.robots,
        result=state.result,
        trouble=None if state.status.ended else trouble,
        waits=waits_of(state),
        live=state.live,
    )


def waits_of(state: RunState) -> list[WaitView]:
    """The leaves before which a robot waits to be let go."""
    return [_wait(state, hold) for hold in state.held]


def _wait(state: RunState, hold: Hold) -> WaitView:
    tree, before = state.tree, hold.breakpoint
    word = None if before is None else state.steering.breakpoints[before]
    return WaitView(
        node=tree.path_of(hold.leaf),
        name=tree.name_of(hold.leaf),
        breakpoint=None if before is None else tree.path_of(before),
        by=None if word is None else word.by,
        reason="" if word is None else word.reason,
        level=state.steering.level,
    )


def steering_view(state: RunState) -> SteeringView:
    """How a run is steered now."""
    tree, steering = state.tree, state.steering
    preferred = None
    if steering.next is not None and steering.preferred is not None:
        leaf, word = steering.next
        preferred = PreferredView(
            node=tree.path_of(leaf), name=tree.name_of(leaf), by=word.by, reason=word.reason
        )
    return SteeringView(
        run=state.id,
        seq=state.seq,
        autonomy=steering.level,
        breakpoints=[
            BreakpointView(
                node=tree.path_of(node), name=tree.name_of(node), by=word.by, reason=word.reason
            )
            for node, word in sorted(steering.breakpoints.items())
        ],
        preferred=preferred,
        waits=waits_of(state),
    )


def summary_of_indexed(run: IndexedRun) -> RunSummary:
    """One line about a run that is not in memory, as the journal's index has it."""
    return RunSummary(
        id=run.run,
        tree=run.tree,
        world=run.world,
        scenario=run.scenario,
        seed=run.seed,
        speed=run.speed,
        status=RunStatus(run.status),
        time=run.time,
        started=run.started,
        ended=run.ended_at,
        robots=list(run.robots),
        result=_result_of_indexed(run),
    )


def _result_of_indexed(run: IndexedRun) -> RunResult | None:
    if run.status == UNREADABLE:
        return RunResult(reason=run.why or "it cannot be read")
    if run.ending is None or run.ended is None:
        return None
    try:
        return result_of(cast(Ending, read_event(run.ended, run.ending)))
    except JournalReadError as error:
        return RunResult(reason=str(error))


NODES = 250
"""So many nodes are viewed at a time."""

_nodes: TypeAdapter[list[NodeView]] = TypeAdapter(list[NodeView])


class RunViewing:
    """Everything about a run as it is now, viewed in pieces: the run may go on meanwhile.

    `leaf_potentials` are those of the leaves, by node.
    """

    def __init__(
        self, state: RunState, time: float, leaf_potentials: Sequence[float], trouble: str | None
    ) -> None:
        self._tree = state.tree.copy()
        self._leaf_potentials = leaf_potentials
        self._without_nodes = RunView(
            **summary(state, time, trouble).model_dump(),
            seq=state.seq,
            nodes=[],
            dialogues=[dialogue_view(each) for each in state.open_dialogues],
            options=state.started.options,
        )

    async def view(self) -> RunView:
        """The view as an object."""
        nodes = [node async for piece in self._pieces() for node in piece]
        return self._without_nodes.model_copy(update={"nodes": nodes})

    async def json(self) -> list[bytes]:
        """The view in JSON, in pieces; never is there an object for each of very many nodes."""
        # Nothing that the other fields hold looks like it: in a string its quotes are escaped.
        head, between, tail = self._without_nodes.model_dump_json().partition('"nodes":[')
        written = [f"{head}{between}".encode()]
        async for piece in self._pieces():
            if len(written) > 1:
                written.append(b",")
            # Without the brackets around the list.
            written.append(_nodes.dump_json(piece)[1:-1])
        return [*written, tail.encode()]

    async def _pieces(self) -> AsyncIterator[list[NodeView]]:
        # What had to be taken of the run at one moment is taken, which took a while itself.
        await asyncio.sleep(0)
        turns = Turns()
        evaluation = self._tree.evaluation(self._leaf_potentials)
        for _ in evaluation.pieces():
            await turns.pass_on()
        for begin in range(0, len(self._tree), NODES):
            end = min(begin + NODES, len(self._tree))
            yield [self._node(node, evaluation) for node in range(begin, end)]
            await turns.pass_on()

    def _node(self, node: int, evaluation: FullEvaluation) -> NodeView:
        tree = self._tree
        return NodeView(
            node=tree.path_of(node),
            name=tree.name_of(node),
            kind=tree.kind_of(node).value,
            behavior=tree.nodes.behavior(node),
            object=tree.nodes.text(node, "object"),
            place=tree.nodes.text(node, "place"),
            activation_level=evaluation.levels[node],
            activation_potential=evaluation.potentials[node],
            active=tree.active(node),
            done=tree.done(node),
            abandoned=tree.abandoned(node),
            owner=tree.owner(node),
            attempts=tree.attempts(node),
        )


def dialogue_view(dialogue: DialogueState) -> DialogueView:
    """One dialogue as clients see it."""
    opened, prompt = dialogue.opened, dialogue.prompt
    awaiting: Literal["answer", "help"] | None = None
    if dialogue.closed is None:
        awaiting = "help" if dialogue.awaiting else "answer" if dialogue.open_ask else None
    last_answer = next(reversed(dialogue.answers.values()), None)
    return DialogueView(
        dialogue=dialogue.id,
        run=opened.run,
        status="closed" if dialogue.closed else "open",
        reason=dialogue.closed,
        issue=opened.issue,
        object=opened.object,
        robot=opened.robot,
        node=opened.node,
        name=opened.name,
        scripted=opened.scripted,
        interrupts=dialogue.raised.interrupts,
        prompt=None
        if prompt is None
        else PromptView(
            prompt=prompt.prompt,
            version=prompt.version,
            kind=prompt.kind,
            text=prompt.text,
            answers=prompt.answers,
            deadline=prompt.deadline,
            to=prompt.to,
            timeout_effect=prompt.timeout_effect,
            within_s=dialogue.asked_for_s if prompt.kind == "ask" else None,
            extensions_left=dialogue.extensions_left if prompt.kind == "ask" else 0,
            headline=prompt.headline,
            ways=prompt.ways,
            wordings=prompt.wordings,
        ),
        awaiting=awaiting,
        answered_by=last_answer.helper if last_answer else None,
        claimed_by=dialogue.claim.helper if dialogue.claim else None,
        claimed_until=dialogue.claim.until if dialogue.claim else None,
        picture=dialogue.raised.picture,
        clip=dialogue.clip,
        detection=dialogue.raised.detection,
        help=None if dialogue.closed else _awaited_help(dialogue),
        unseen_help=_unseen_help(dialogue),
    )


def robot_view(
    robot: str, hello: Hello | None, connected: bool, state_of_run: RunState | None
) -> RobotView:
    """One robot; `state_of_run` is that of the run that owns it, if one does."""
    state: Literal["idle", "working", "holding", "lost"] = "idle"
    if not connected:
        state = "lost"
    elif state_of_run is not None:
        execution = state_of_run.executions.get(robot)
        if execution is not None:
            state = "holding" if execution.held else "working"
    return RobotView(
        robot=robot,
        connected=connected,
        simulated=bool(hello and hello.simulated),
        behaviors=hello.behaviors if hello else [],
        cameras=hello.cameras if hello else [],
        reach=hello.reach.model_dump() if hello and hello.reach else None,
        run=state_of_run.id if state_of_run else None,
        state=state,
        model=hello.shows.model if hello and hello.shows else None,
    )


def _awaited_help(dialogue: DialogueState) -> AwaitedHelp | None:
    awaited = dialogue.awaiting
    if awaited is None:
        return None
    return AwaitedHelp(
        help=awaited.help,
        helper=awaited.helper,
        until=awaited.until,
        within_s=awaited.until - awaited.time,
        reported_by=None if dialogue.reported is None else dialogue.reported.helper,
        at_a_word=awaited.guess is None,
    )


def _unseen_help(dialogue: DialogueState) -> UnseenHelpView | None:
    unseen = dialogue.last_unseen
    if unseen is None or unseen.picture is None:
        return None
    return UnseenHelpView(time=unseen.time, picture=unseen.picture, detection=unseen.detection)
