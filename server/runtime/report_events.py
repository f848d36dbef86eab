"""From a robot's reports to the events that journal them."""

import logging
from uuid import UUID, uuid4

from mend.robots.execution.phase import Phase
from mend.robots.link.jpeg import NotJpegError, read_jpeg
from mend.robots.link.messages import (
    ClipTaken,
    Finished,
    Holding,
    Intervened,
    IssueDetected,
    Rejected,
    ReportBody,
    Resumed,
    StepStarted,
    WayFound,
)
from mend.server.journal import events as ev
from mend.server.plain_text import plain
from mend.server.runtime.context import RunContext
from mend.server.runtime.dialogue_driver import DialogueDriver
from mend.server.runtime.robot_proxy import RobotActivity, RobotProxy
from mend.server.runtime.run_state import StartedExecution
from mend.tasks.resolution import Resolution

log = logging.getLogger(__name__)


class ReportEvents:
    """Reads reports. One about an execution that is over is no news, and gives no event."""

    def __init__(self, context: RunContext, dialogues: DialogueDriver) -> None:
        self._context = context
        self._dialogues = dialogues

    def read(self, proxy: RobotProxy, body: ReportBody) -> tuple[list[ev.Event], dict[UUID, bytes]]:
        """The events of a report, and the pictures (JPEG) that they name."""
        pictures: dict[UUID, bytes] = {}
        events: list[ev.Event] = []
        match body:
            case StepStarted():
                events = self._step_started(proxy, body)
            case IssueDetected():
                events = self._issue_detected(proxy, body, pictures)
            case ClipTaken():
                events = self._clip_taken(body, pictures)
            case Finished():
                events = self._finished(proxy, body)
            case Holding():
                events = [ev.RobotHolding(**self._context.stamp(), robot=proxy.robot, at=body.at)]
            case Resumed():
                events = [
                    ev.RobotResumed(**self._context.stamp(), robot=proxy.robot, step=body.step)
                ]
            case WayFound():
                events = [
                    ev.WayFound(
                        **self._context.stamp(),
                        robot=proxy.robot,
                        finding=body.finding,
                        between=body.between,
                    )
                ]
            case Intervened():
                events = [self._intervened(body)]
            case Rejected():
                events = self._rejected(proxy, body)
        return events, pictures

    def node(self, leaf: int) -> dict[str, str]:
        """What every event of a node has."""
        tree = self._context.state.tree
        return {"node": tree.path_of(leaf), "name": tree.name_of(leaf)}

    def reset(self, leaf: int, robot: str | None, reason: str, *, failed: bool) -> ev.NodeReset:
        return ev.NodeReset(
            **self._context.stamp(),
            **self.node(leaf),
            robot=robot,
            reason=reason,
            failed_attempt=failed,
        )

    def _current(self, proxy: RobotProxy, execution: str) -> StartedExecution | None:
        """The robot's execution, if the report is about that and not about an earlier one."""
        current = self._context.state.executions.get(proxy.robot)
        return current if current is not None and str(current.id) == execution else None

    def _step_started(self, proxy: RobotProxy, body: StepStarted) -> list[ev.Event]:
        execution = self._current(proxy, body.execution)
        if execution is None:
            return []
        return [
            *self._too_late_for_help(proxy, execution.leaf, body.phase),
            ev.StepStarted(
                **self._context.stamp(),
                **self.node(execution.leaf),
                robot=proxy.robot,
                execution=execution.id,
                step=body.step,
                step_name=body.name,
                phase=body.phase,
                object=self._context.state.tree.leaf_definition(execution.leaf).object,
            ),
        ]

    def _too_late_for_help(self, proxy: RobotProxy, leaf: int, phase: str | None) -> list[ev.Event]:
        """Nobody can help to place what the robot lets go of: a question about that lapses."""
        asked = self._context.state.dialogue_of(leaf)
        if asked is None or asked.raised.interrupts or phase != Phase.RELEASE:
            return []
        return self._dialogues.too_late(asked, proxy)

    def _issue_detected(
        self, proxy: RobotProxy, body: IssueDetected, pictures: dict[UUID, bytes]
    ) -> list[ev.Event]:
        execution = self._current(proxy, body.execution)
        state = self._context.state
        if execution is None:
            return []
        open_one = state.dialogue_of(execution.leaf)
        if open_one is not None and open_one.raised.interrupts:
            return []
        # A question that held nothing up lapses once something else is wrong.
        lapsed = [] if open_one is None else [self._dialogues.abort(open_one)]
        picture = _decode(body.jpeg)
        picture_id = uuid4() if picture else None
        if picture_id is not None and picture is not None:
            pictures[picture_id] = picture
        leaf = state.tree.leaf_definition(execution.leaf)
        raised = ev.IssueRaised(
            **self._context.stamp(),
            **self.node(execution.leaf),
            robot=proxy.robot,
            issue=body.issue,
            object=leaf.object,
            place=leaf.place,
            item=leaf.item,
            message=leaf.message,
            person=leaf.person,
            held_by=leaf.held_by,
            away_m=leaf.away_m,
            execution=execution.id,
            step=body.step,
            interrupts=body.interrupts,
            detection=body.detection,
            picture=picture_id,
        )
        if body.issue not in state.scripts:
            reason = f"there is no dialogue script for an issue '{body.issue}'"
            reset = self.reset(execution.leaf, proxy.robot, reason, failed=True)
            return [*lapsed, raised, reset] if body.interrupts else [*lapsed, raised]
        return [*lapsed, *self._dialogues.open(raised, proxy)]

    def _clip_taken(self, body: ClipTaken, pictures: dict[UUID, bytes]) -> list[ev.Event]:
        """The clip of an issue that opened a dialogue; of another one it is not kept."""
        dialogues = reversed(self._context.state.dialogues.values())
        dialogue = next(
            (
                each
                for each in dialogues
                if str(each.raised.execution) == body.execution and each.raised.issue == body.issue
            ),
            None,
        )
        # Of one issue there is one clip; who sends more has nothing new to show.
        if dialogue is None or dialogue.clip:
            return []
        raised, clip = dialogue.raised, []
        for each in body.pictures:
            jpeg = _decode(each.jpeg)
            if jpeg is not None:
                picture = uuid4()
                pictures[picture] = jpeg
                time = max(0.0, raised.time - each.before_s)
                clip.append(ev.ClipPicture(time=time, picture=picture))
        return [
            ev.ClipRecorded(
                **self._context.stamp(),
                node=raised.node,
                name=raised.name,
                robot=raised.robot,
                issue=raised.issue,
                execution=raised.execution,
                dialogue=dialogue.id,
                pictures=clip,
            )
        ]

    def _finished(self, proxy: RobotProxy, body: Finished) -> list[ev.Event]:
        execution = self._current(proxy, body.execution)
        if execution is None:
            return []
        state = self._context.state
        path = state.tree.path_of(execution.leaf)
        helped = any(
            each.resolved is not None
            and each.resolved.helped
            and each.resolved.resolution is Resolution.COLLAB_FINISH
            and each.raised.execution == execution.id
            for each in state.dialogues.values()
        )
        events: list[ev.Event] = [
            self._dialogues.abort(each) for each in state.open_dialogues if each.opened.node == path
        ]
        done = ev.NodeDone(
            **self._context.stamp(),
            **self.node(execution.leaf),
            robot=proxy.robot,
            by="found" if body.found_in_place else "both" if helped else "robot",
        )
        return [*events, done]

    def _intervened(self, body: Intervened) -> ev.InterventionDone:
        return ev.InterventionDone(
            **self._context.stamp(),
            act=str(body.intervention.act),
            object=body.intervention.object,
            intervention=body.intervention,
            by=body.by,
            ok=body.ok,
            detail=body.detail,
            command=body.command,
        )

    def _rejected(self, proxy: RobotProxy, body: Rejected) -> list[ev.Event]:
        execution = self._context.state.executions.get(proxy.robot)
        if body.command == proxy.command:
            # Once for each command: anybody can reject what was never told.
            log.warning("robot %s rejected a command: %s", proxy.robot, plain(body.reason))
        if (
            execution is None
            or body.for_good
            or proxy.doing is not RobotActivity.WORKING
            or body.command != proxy.command
        ):
            return []
        reason = f"the robot refused: {body.reason}"
        return [self.reset(execution.leaf, proxy.robot, reason, failed=True)]


def _decode(jpeg: str | None) -> bytes | None:
    if jpeg is None:
        return None
    try:
        return read_jpeg(jpeg)
    except NotJpegError as error:
        log.warning("a robot's picture %s", error)
        return None
