"""A runtime without robots: runs and dialogues in memory, their events in a real journal."""

from collections import Counter
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime, timedelta
from typing import Any, Literal
from uuid import UUID, uuid4

from mend.dialogue.script import CloseReason, Help
from mend.errors import ConflictError, NotFoundError, WrongInputError
from mend.server.camera_picture import CameraPicture
from mend.server.dialogues.who_helps import HelpersView
from mend.server.documents import CheckedDocument, DocumentMistake, Uploaded, WrongDocumentError
from mend.server.errors import LostRaceError
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry, Journal
from mend.server.journal.run_index import RunPage
from mend.server.runtime.leaf_words import understood
from mend.server.runtime.question_queue import OpenQuestion, batches_of
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.steering_views import (
    AnySteering,
    NodeSteeringView,
    SteeringView,
    SteerNode,
)
from mend.server.runtime.views import (
    AwaitedHelp,
    ChosenView,
    DialogueView,
    LeafSaid,
    NodeView,
    PromptView,
    QuestionBatchView,
    QuestionView,
    RobotView,
    RunResult,
    RunStatus,
    RunSummary,
    RunView,
    Snapshot,
    WorldView,
)
from mend.tasks.autonomy import AutonomyLevel
from mend.tasks.intervention import Intervention

TREES = {"eket": "then: []", "tea_table": "and: []"}
JPEG = b"\xff\xd8\xff\xd9"


class FakeTreeChecker:
    """Takes any text that has a `then` or `and`; a first line `name: x` names it."""

    def check(self, text: str, uploaded: Uploaded) -> CheckedDocument:  # noqa: ARG002
        if "then" not in text and "and" not in text:
            mistake = DocumentMistake(line=1, column=1, node=None, message="there is no goal node")
            raise WrongDocumentError("task", [mistake])
        name = text.removeprefix("name: ").split("\n")[0].strip() if "name: " in text[:6] else None
        return CheckedDocument(name, {"text": text})

    try_in_worlds = check


class FakeWorlds:
    """A `WorldList` of one that can run and one that cannot."""

    def worlds(self) -> list[WorldView]:
        return [
            WorldView(name="tabletop", available=True, reason=None, options={}),
            WorldView(name="workcell", available=False, reason="it needs PyBullet", options={}),
        ]


_IN_A_QUEUE = {"dialogue", "run", "robot", "name", "object", "claimed_by"}


class FakeRuns:
    """A `RunService`; `raise_issue` does what a robot would."""

    def __init__(self, journal: Journal) -> None:
        self._journal = journal
        self._runs: dict[UUID, RunView] = {}
        self._dialogues: dict[UUID, DialogueView] = {}
        self.places: dict[UUID, str] = {}
        """Where leaves belong that dialogues are about."""
        self._answers: dict[UUID, str] = {}
        self.photographed: list[tuple[str | None, str]] = []
        """Of which robot a picture was asked for, and from which camera."""

    async def start_run(self, request: RunRequest, author: ev.Author | None = None) -> RunView:
        if request.tree not in TREES:
            raise NotFoundError(f"there is no tree '{request.tree}'")
        if request.world not in ("workcell", "tabletop"):
            raise WrongInputError(f"there is no world '{request.world}'")
        if request.scenario not in (None, "eket_paper"):
            raise NotFoundError(f"there is no scenario '{request.scenario}'")
        run = uuid4()
        self._runs[run] = RunView(
            id=run,
            tree=request.tree,
            world=request.world,
            scenario=request.scenario,
            seed=request.seed,
            speed=request.speed,
            status=RunStatus.RUNNING,
            time=0.0,
            started=datetime.now(UTC),
            robots=["robot"],
            result=None,
            seq=0,
            nodes=[leaf()],
            dialogues=[],
            options={},
        )
        await self.commit(
            ev.RunStarted(
                **_stamp(run),
                tree_name=request.tree,
                tree={},
                scene={},
                world=request.world,
                robots=["robot"],
                seed=request.seed,
                speed=request.speed,
                scenario=request.scenario,
                options=request.model_dump(mode="json"),
                author=author,
            )
        )
        return self.run_now(run)

    async def commit(self, *events: ev.Event) -> Sequence[ev.Event]:
        return await self._journal.append(Entry(events=events))

    async def runs(self, page: RunPage) -> list[RunSummary]:
        fields = set(RunSummary.model_fields)
        listed = [
            RunSummary(**run.model_dump(include=fields))
            for run in reversed(self._runs.values())
            if page.statuses is None or run.status in page.statuses
        ]
        if page.before is not None:
            self.run_now(page.before)
            listed = listed[[run.id for run in listed].index(page.before) + 1 :]
        return listed[page.offset : page.offset + page.limit]

    def helpers(self) -> HelpersView:
        return HelpersView(in_turn=False, helpers=[])

    async def count_runs(self) -> Mapping[RunStatus, int]:
        return Counter(run.status for run in self._runs.values())

    async def run(self, run: UUID) -> RunView:
        return self.run_now(run)

    async def run_summary(self, run: UUID) -> RunSummary:
        return RunSummary(**self.run_now(run).model_dump(include=set(RunSummary.model_fields)))

    async def run_json(self, run: UUID) -> list[bytes]:
        return [self.run_now(run).model_dump_json().encode()]

    def run_now(self, run: UUID) -> RunView:
        if run not in self._runs:
            raise NotFoundError(f"there is no run {run}")
        mine = [each for each in self._dialogues.values() if each.run == run]
        return self._runs[run].model_copy(
            update={
                "seq": self._journal.head,
                "dialogues": [each for each in mine if each.status == "open"],
            }
        )

    async def pause(self, run: UUID, author: ev.Author | None = None) -> RunView:
        self._expect(run, RunStatus.RUNNING)
        return await self._become(run, RunStatus.PAUSED, ev.RunPaused(**_stamp(run), author=author))

    async def resume(self, run: UUID, author: ev.Author | None = None) -> RunView:
        self._expect(run, RunStatus.PAUSED)
        return await self._become(
            run, RunStatus.RUNNING, ev.RunResumed(**_stamp(run), author=author)
        )

    async def abort(self, run: UUID, author: ev.Author | None = None) -> RunView:
        self._expect(run, RunStatus.RUNNING, RunStatus.PAUSED)
        return await self._become(
            run, RunStatus.ABORTED, ev.RunAborted(**_stamp(run), author=author)
        )

    def _expect(self, run: UUID, *allowed: RunStatus) -> None:
        status = self.run_now(run).status
        if status not in allowed:
            raise ConflictError(f"the run is {status}")

    async def _become(self, run: UUID, status: RunStatus, event: ev.Event) -> RunView:
        await self.commit(event)
        result = RunResult(reason="aborted") if status.ended else None
        self._runs[run] = self._runs[run].model_copy(update={"status": status, "result": result})
        return self.run_now(run)

    async def take_leaf(
        self,
        run: UUID,
        node: str,
        helper: str,
        author: ev.Author | None = None,
    ) -> RunSummary:
        self._expect(run, RunStatus.RUNNING, RunStatus.PAUSED)
        taken = {"node": node, "name": node, "helper": helper, "until": 120.0, "was_at": None}
        await self.commit(ev.NodeTaken(**_stamp(run), **taken, author=author))
        return self.run_now(run)

    async def give_leaf_back(self, run: UUID, node: str, helper: str) -> RunSummary:  # noqa: ARG002
        self._expect(run, RunStatus.RUNNING, RunStatus.PAUSED)
        return self.run_now(run)

    async def say_of_leaf(
        self,
        run: UUID,
        words: str,
        helper: str,
        author: ev.Author | None = None,
    ) -> LeafSaid:
        said = understood(words)
        await self.take_leaf(run, "/0", helper, author)
        return LeafSaid(deed=said.deed, node="/0", name=said.part)

    async def steer(
        self, run: UUID, wish: AnySteering, by: str, author: ev.Author | None = None
    ) -> SteeringView:
        """Only breakpoints, as many as there are."""
        self._expect(run, RunStatus.RUNNING, RunStatus.PAUSED)
        if isinstance(wish, SteerNode):
            await self.commit(
                ev.BreakpointSet(
                    **_stamp(run), node=wish.node, name=wish.node, by=by, author=author
                )
            )
        return await self.steering(run)

    async def steering(self, run: UUID) -> SteeringView:
        return SteeringView(
            run=self.run_now(run).id,
            seq=0,
            autonomy=AutonomyLevel.FULL,
            breakpoints=[],
            preferred=None,
            waits=[],
        )

    async def steering_of(self, run: UUID, node: str) -> NodeSteeringView:
        found = self.run_now(run).id
        return NodeSteeringView(run=found, node=node, name=node, seq=0, offered=[], refused=[])

    async def record(
        self, run: UUID, seconds: float, by: str, author: ev.Author | None = None
    ) -> ev.RecordingBegun:
        self._expect(run, RunStatus.RUNNING, RunStatus.PAUSED)
        begun = ev.RecordingBegun(
            **_stamp(run), robots=["robot"], seconds=seconds, by=by, author=author
        )
        (numbered,) = await self.commit(begun)
        assert isinstance(numbered, ev.RecordingBegun)
        return numbered

    async def intervene(
        self, run: UUID, intervention: Intervention, author: ev.Author | None = None
    ) -> None:
        self._expect(run, RunStatus.RUNNING, RunStatus.PAUSED)
        await self.commit(
            ev.InterventionAccepted(
                **_stamp(run),
                act=intervention.act,
                object=intervention.object,
                intervention=intervention,
                by="api",
                command=str(uuid4()),
                author=author,
            ),
            ev.InterventionDone(
                **_stamp(run),
                act=intervention.act,
                object=intervention.object,
                intervention=intervention,
                by="api",
            ),
        )

    async def picture(self, run: UUID, camera: str, robot: str | None = None) -> CameraPicture:
        self.run_now(run)
        self.photographed.append((robot, camera))
        if camera not in ("head", "forearm"):
            raise NotFoundError(f"there is no camera '{camera}'")
        return CameraPicture(JPEG)

    async def raise_issue(self, run: UUID) -> DialogueView:
        """Open a dialogue with one question and a picture."""
        picture = uuid4()
        raised = ev.IssueRaised(
            **_stamp(run),
            node="/0",
            name="pink_bar",
            robot="robot",
            issue="dropped",
            object="pink_bar",
            place="pink_place",
            execution=uuid4(),
            step=4,
            interrupts=True,
            picture=picture,
        )
        await self._journal.append(Entry(events=[raised], pictures={picture: JPEG}))
        prompt = PromptView(
            prompt=uuid4(),
            version=1,
            kind="ask",
            text="I dropped the pink bar. Shall I pick it up again?",
            answers=[
                ev.AnswerOption(value="yes", effect="The robot tries again."),
                ev.AnswerOption(value="no", effect="You put the pink bar to its place."),
            ],
            deadline=30.0,
            to=None,
            within_s=30.0,
            extensions_left=10,
        )
        view = DialogueView(
            dialogue=uuid4(),
            run=run,
            status="open",
            reason=None,
            issue="dropped",
            object="pink_bar",
            robot="robot",
            node="/0",
            name="pink_bar",
            prompt=prompt,
            awaiting="answer",
            answered_by=None,
            claimed_by=None,
            claimed_until=None,
            picture=picture,
        )
        self._dialogues[view.dialogue] = view
        await self.commit(
            ev.DialogueOpened(**_of_dialogue(view)),
            ev.Prompt(
                **_of_dialogue(view),
                **prompt.model_dump(exclude={"within_s", "extensions_left"}),
            ),
        )
        return view

    @property
    def dialogues(self) -> "FakeRuns":
        return self

    async def page(
        self, status: Literal["open", "closed"] | None, limit: int, offset: int
    ) -> list[DialogueView]:
        listed = [each for each in self._dialogues.values() if status in (None, each.status)]
        return listed[offset : offset + limit]

    def count_open(self) -> int:
        return sum(each.status == "open" for each in self._dialogues.values())

    async def view(self, dialogue: UUID) -> DialogueView:
        return self.dialogue_now(dialogue)

    def dialogue_now(self, dialogue: UUID) -> DialogueView:
        if dialogue not in self._dialogues:
            raise NotFoundError(f"there is no dialogue {dialogue}")
        return self._dialogues[dialogue]

    async def answer(
        self,
        dialogue: UUID,
        prompt: UUID,
        answer: Literal["yes", "no"],
        helper: str,
        author: ev.Author | None = None,
    ) -> ev.Answered:
        view = self.dialogue_now(dialogue)
        if view.prompt is None or view.prompt.prompt != prompt:
            raise NotFoundError(f"there is no prompt {prompt}")
        if prompt in self._answers:
            raise LostRaceError(prompt, self._answers[prompt])
        self._answers[prompt] = helper
        self._change(dialogue, status="closed", reason="resolved", answered_by=helper)
        answered, _ = await self.commit(
            ev.Answered(
                **_of_dialogue(view),
                prompt=prompt,
                version=1,
                answer=answer,
                helper=helper,
                author=author,
            ),
            ev.DialogueClosed(**_of_dialogue(view), reason=CloseReason.RESOLVED),
        )
        assert isinstance(answered, ev.Answered)
        return answered

    def questions(self) -> list[QuestionBatchView]:
        return batches_of(self._open_questions())

    async def choose_for_all(
        self, way: str, prompts: Sequence[UUID], helper: str, author: ev.Author | None = None
    ) -> list[ChosenView]:
        open_ = {each.view.prompt: each.view.dialogue for each in self._open_questions()}
        if any(prompt not in open_ for prompt in prompts):
            raise NotFoundError("there is no such open question")
        for prompt in prompts:
            await self.dialogues.choose(open_[prompt], prompt, way, helper, author)
        return [ChosenView(dialogue=open_[prompt], prompt=prompt) for prompt in prompts]

    def _open_questions(self) -> list[OpenQuestion]:
        return [
            OpenQuestion(
                QuestionView(
                    **view.model_dump(include=_IN_A_QUEUE),
                    tree="eket",
                    place=self.places.get(view.dialogue),
                    attempt=1,
                    attempts=3,
                    prompt=view.prompt.prompt,
                    headline=view.prompt.headline or view.prompt.text,
                    left_s=view.prompt.deadline,
                    opened=datetime(2026, 1, 1, tzinfo=UTC),
                    to=view.prompt.to,
                ),
                view.issue,
                view.prompt.ways,
                number,
            )
            for number, view in enumerate(self._dialogues.values())
            if view.awaiting == "answer" and view.prompt is not None
        ]

    def offer_ways(self, dialogue: UUID, ways: list[ev.WayOption]) -> None:
        """From now on the open question has these ways of help."""
        prompt = self.dialogue_now(dialogue).prompt
        assert prompt is not None, "nothing is asked"
        self._change(dialogue, prompt=prompt.model_copy(update={"ways": ways}))

    async def choose(
        self,
        dialogue: UUID,
        prompt: UUID,
        way: str,
        helper: str,
        author: ev.Author | None = None,
    ) -> ev.Answered:
        if way != "help":
            raise ConflictError(f"'{way}' is no way to answer this question: there are help")
        return await self.answer(dialogue, prompt, "yes", helper, author)

    async def extend(
        self, dialogue: UUID, prompt: UUID, helper: str, author: ev.Author | None = None
    ) -> ev.DeadlineExtended:
        view = self.dialogue_now(dialogue)
        if view.prompt is None or view.prompt.prompt != prompt:
            raise NotFoundError(f"there is no prompt {prompt}")
        if view.status == "closed" or view.prompt.extensions_left == 0:
            raise ConflictError("this question gets no more time")
        deadline, left = (view.prompt.deadline or 0.0) + 30.0, view.prompt.extensions_left - 1
        moved = view.prompt.model_copy(update={"deadline": deadline, "extensions_left": left})
        self._change(dialogue, prompt=moved)
        (extended,) = await self.commit(
            ev.DeadlineExtended(
                **_of_dialogue(view),
                prompt=prompt,
                version=1,
                deadline=deadline,
                extensions_left=left,
                helper=helper,
                author=author,
            )
        )
        assert isinstance(extended, ev.DeadlineExtended)
        return extended

    async def await_help(self, dialogue: UUID, helper: str) -> None:
        """A helper has promised to put it back."""
        awaited = AwaitedHelp(help=Help.PUT_BACK, helper=helper, until=90.0)
        self._change(dialogue, awaiting="help", help=awaited)

    def awaited(self, dialogue: UUID) -> AwaitedHelp:
        view = self.dialogue_now(dialogue)
        if view.status == "closed" or view.help is None:
            raise ConflictError("no help is awaited in this dialogue")
        return view.help

    async def said_done(
        self, dialogue: UUID, helper: str, author: ev.Author | None = None
    ) -> ev.HelpReported:
        awaited, of = self.awaited(dialogue), _of_dialogue(self.dialogue_now(dialogue))
        if awaited.reported_by is not None:
            raise ConflictError("the robot looks already")
        said = ev.HelpReported(**of, help=awaited.help, helper=helper, author=author)
        (reported,) = await self.commit(said)
        self._change(dialogue, help=awaited.model_copy(update={"reported_by": helper}))
        assert isinstance(reported, ev.HelpReported)
        return reported

    async def take_back(
        self, dialogue: UUID, helper: str, author: ev.Author | None = None
    ) -> ev.PromiseTakenBack:
        awaited, of = self.awaited(dialogue), _of_dialogue(self.dialogue_now(dialogue))
        if awaited.helper != helper:
            raise ConflictError(f"{awaited.helper} has promised this")
        said = ev.PromiseTakenBack(**of, help=awaited.help, helper=helper, author=author)
        (taken_back,) = await self.commit(said)
        self._change(dialogue, awaiting=None, help=None)
        assert isinstance(taken_back, ev.PromiseTakenBack)
        return taken_back

    async def claim(
        self,
        dialogue: UUID,
        helper: str,
        *,
        take_over: bool = False,
        author: ev.Author | None = None,
    ) -> DialogueView:
        view = self.dialogue_now(dialogue)
        if view.status == "closed":
            raise ConflictError("the dialogue is closed")
        if view.claimed_by not in (None, helper) and not take_over:
            raise ConflictError(f"{view.claimed_by} is on it")
        until = datetime.now(UTC) + timedelta(seconds=30)
        await self.commit(
            ev.Claimed(**_of_dialogue(view), helper=helper, lease_until=until, author=author)
        )
        return self._change(dialogue, claimed_by=helper, claimed_until=until)

    async def release(
        self, dialogue: UUID, helper: str, author: ev.Author | None = None
    ) -> DialogueView:
        view = self.dialogue_now(dialogue)
        if view.claimed_by != helper:
            raise ConflictError(f"{helper} has no claim on it")
        await self.commit(ev.Released(**_of_dialogue(view), helper=helper, author=author))
        return self._change(dialogue, claimed_by=None, claimed_until=None)

    def _change(self, dialogue: UUID, **fields: Any) -> DialogueView:
        self._dialogues[dialogue] = self._dialogues[dialogue].model_copy(update=fields)
        return self._dialogues[dialogue]

    def robots(self) -> list[RobotView]:
        return [
            RobotView(
                robot="robot",
                connected=True,
                simulated=True,
                behaviors=["pick_and_place"],
                cameras=["head", "forearm"],
                reach={"x": 0.0, "y": 0.0, "min_m": 0.3, "max_m": 0.9},
                run=None,
                state="idle",
            )
        ]

    async def snapshot(self, seq: int | None) -> Snapshot:
        return Snapshot(
            seq=self._journal.head if seq is None else seq,
            runs=[self.run_now(run) for run, view in self._runs.items() if not view.status.ended],
            dialogues=[each for each in self._dialogues.values() if each.status == "open"],
        )


def leaf() -> NodeView:
    return NodeView(
        node="/0",
        name="pink_bar",
        kind="behavior",
        behavior="pick_and_place",
        object="pink_bar",
        place="pink_place",
        activation_level=1.0,
        activation_potential=0.5,
        active=True,
        done=False,
        abandoned=False,
        owner="robot",
        attempts=0,
    )


def _stamp(run: UUID) -> dict[str, Any]:
    return {"time": 1.0, "wall_time": datetime.now(UTC), "run": run}


def _of_dialogue(view: DialogueView) -> dict[str, Any]:
    fields = view.model_dump(include={"dialogue", "robot", "issue", "object", "node", "name"})
    return {**_stamp(view.run), **fields}
