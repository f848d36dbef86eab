"""What the robot looks for while a dialogue is open, and what each look is compared with."""

from dataclasses import replace
from uuid import UUID

from mend.dialogue.evidence import (
    Change,
    LookOutcome,
    Point,
    PutRight,
    brought_before,
    change_since,
    contradiction,
    has_moved,
    known_before,
    known_when_raised,
    put_right,
)
from mend.dialogue.script import EXPECTED, Expectation, Help
from mend.robots.link.messages import FinishedResult
from mend.server.journal import events as ev
from mend.server.runtime.clock import has_come
from mend.server.runtime.context import RunContext
from mend.server.runtime.dialogue_state import DialogueState
from mend.server.runtime.robot_proxy import Purpose, RobotActivity, RobotProxy

FIRST_LOOK_S = 1.0
"""So long the first look may take to see whether an object rests within reach."""

WATCH_PERIOD_S = 2.0
"""How often the robot looks whether what was right when it asked has changed."""

_WITHOUT_OBJECT = (
    Expectation.WAY_CLEAR,
    Expectation.VIEW_CLEAR,
    Expectation.LOCATED,
    Expectation.LOADED,
    Expectation.UNLOADED,
    Expectation.CHARGED,
    Expectation.ACCOMPANIED,
)
"""What a look may be asked to wait for that is about no object."""

HELP_TAKES_S = 10.0
"""So long a helper is given where a look could not tell help that is still to come from none."""


AT_A_WORD_S = 2.0
"""So long a look goes on that is made because somebody says that the help is done,"""

TAKING_S = 5.0
"""and if it takes something that is held out: the arm may have to go there first."""


class DialogueLooks:
    """The looks of one run's dialogues. `rate`: how fast the clock may run meanwhile."""

    def __init__(self, context: RunContext, rate: float | None) -> None:
        self._context = context
        self._rate = rate
        self._next_watch: dict[UUID, float] = {}

    # --- Which look is next -------------------------------------------------------------------

    def let_time_pass(self, dialogue: DialogueState, proxy: RobotProxy, due: float) -> None:
        """Until somebody answers, see whether it is put right; let a simulated clock run."""
        if dialogue.raised.interrupts:
            if self._looks_first(dialogue, proxy, due):
                return
            watched = self._expected(dialogue)
            if watched is not None:
                self._watch(dialogue, proxy, watched, due)
                return
        self._hold(proxy, due)

    def watch_for_help(
        self, dialogue: DialogueState, awaiting: ev.HelpAwaited, proxy: RobotProxy
    ) -> None:
        """Look for promised help, once what was so before has been seen."""
        until = awaiting.until if dialogue.reported is None else dialogue.reported.time
        first = dialogue.first_look is None
        by_eye = awaiting.help is not Help.HAND_OVER and self._is_in_time(until)
        looking = proxy.doing is RobotActivity.LOOKING and proxy.purpose in (
            Purpose.BASELINE,
            Purpose.VIEW,
        )
        if (looking and (first or by_eye)) or not (proxy.free or proxy.interruptible):
            return
        if (first or by_eye) and self._looks_first(dialogue, proxy, until):
            return
        begin = self.help_looked_for_from(dialogue, awaiting)
        if not has_come(self._context.clock, begin):
            if proxy.free:
                self._hold(proxy, begin)
            return
        if awaiting.help is Help.HAND_OVER and not self._may_stretch_out(dialogue, proxy):
            self._hold(proxy, self._context.clock.now() + WATCH_PERIOD_S)
            return
        proxy.look(
            Purpose.HELP,
            object=dialogue.raised.object,
            place=dialogue.raised.place,
            expect=str(EXPECTED[awaiting.help]),
            guess=awaiting.guess,
            within_s=self._looked_for_s(dialogue, awaiting),
            rate=self._rate,
            finished=_result_of(dialogue),
        )

    def _looked_for_s(self, dialogue: DialogueState, awaiting: ev.HelpAwaited) -> float:
        """How long one look for help goes on; one at a helper's word is to tell soon."""
        left_s = max(0.0, awaiting.until - self._context.clock.now())
        if dialogue.reported is None:
            return left_s
        hands_over = awaiting.help is Help.HAND_OVER
        return min(left_s, TAKING_S if hands_over else AT_A_WORD_S)

    def _may_stretch_out(self, dialogue: DialogueState, proxy: RobotProxy) -> bool:
        """Whether no other robot is where it takes the object and places it; then that is its."""
        if proxy.team is None:
            return True
        tree = self._context.state.tree
        leaf = tree.leaf_definition(tree.index_of(dialogue.raised.node))
        if not proxy.team.may_begin(proxy, leaf, handed_over=True):
            return False
        proxy.team.take(proxy, leaf, handed_over=True)
        return True

    def help_looked_for_from(self, dialogue: DialogueState, awaiting: ev.HelpAwaited) -> float:
        """From when (run's clock) promised help is looked for.

        What is as promised already, or was only felt, gives the helper time to do it first, unless
        they say that it is done.
        """
        if dialogue.reported is not None:
            return dialogue.reported.time
        if awaiting.help in (Help.HAND_OVER, Help.TELL_PLACE):
            return awaiting.time
        felt = dialogue.raised.detection is not None and dialogue.raised.detection.felt
        base = self._base(dialogue)
        already = base is not None and EXPECTED[awaiting.help] in base.fulfilled
        if already or (felt and awaiting.help is Help.CLEAR_WAY):
            return min(awaiting.time + HELP_TAKES_S, awaiting.until)
        return awaiting.time

    def next_watch(self, dialogue: DialogueState) -> float | None:
        """When (run's clock) the robot is to look again."""
        if dialogue.awaiting is not None:
            return self.help_looked_for_from(dialogue, dialogue.awaiting)
        return self._next_watch.get(dialogue.id)

    def awaits_view(self, dialogue: DialogueState) -> bool:
        """Whether every look so far was dark, so that nothing can be compared with them yet."""
        first = dialogue.first_look
        dark = first is not None and first.blind and dialogue.looked_anew is None
        return dark and Expectation.VIEW_CLEAR not in dialogue.conversation.puts_right

    def _looks_first(self, dialogue: DialogueState, proxy: RobotProxy, until: float) -> bool:
        """Make the look that later ones are compared with, unless there was one that saw anything.

        Where the camera shows nothing of the table, that waits until it does, or `until` has come.
        """
        dark = self.awaits_view(dialogue)
        if dialogue.first_look is None or (dark and proxy.blind is None):
            self._look_first(dialogue, proxy)
        elif dark and self._is_in_time(until):
            within_s = until - self._context.clock.now()
            self._look(dialogue, proxy, Purpose.VIEW, Expectation.VIEW_CLEAR, within_s)
        else:
            return False
        return True

    def _is_in_time(self, until: float) -> bool:
        return not has_come(self._context.clock, until)

    def _look_first(self, dialogue: DialogueState, proxy: RobotProxy) -> None:
        expect = self._expected_first(dialogue)
        within_s = FIRST_LOOK_S if expect is Expectation.IN_REACH else 0.0
        self._look(dialogue, proxy, Purpose.BASELINE, expect, within_s)

    def _watch(
        self, dialogue: DialogueState, proxy: RobotProxy, watched: Expectation, due: float
    ) -> None:
        now = self._context.clock.now()
        base = self._base(dialogue)
        if base is None or watched not in base.fulfilled:
            self._look(dialogue, proxy, Purpose.WATCH, watched, max(0.0, due - now))
            return
        begin = self._next_watch.setdefault(dialogue.id, now + WATCH_PERIOD_S)
        if not has_come(self._context.clock, begin):
            self._hold(proxy, min(due, begin))
            return
        self._next_watch[dialogue.id] = now + WATCH_PERIOD_S
        self._look(dialogue, proxy, Purpose.WATCH, None, 0.0)

    def _look(
        self,
        dialogue: DialogueState,
        proxy: RobotProxy,
        purpose: Purpose,
        expect: Expectation | None,
        within_s: float,
    ) -> None:
        result = _result_of(dialogue)
        if expect is None:
            proxy.look(purpose, rate=self._rate, finished=result)
            return
        proxy.look(
            purpose,
            object=dialogue.raised.object,
            place=dialogue.raised.place,
            expect=str(expect),
            within_s=within_s,
            rate=self._rate,
            finished=result,
        )

    def _hold(self, proxy: RobotProxy, until: float) -> None:
        if proxy.hello is not None and proxy.hello.simulated:
            proxy.hold(self._context.clock.to_robot(until), self._rate)

    def _expected(self, dialogue: DialogueState) -> Expectation | None:
        """What a look is asked to wait for; where an object is, every look tells."""
        watched = dialogue.conversation.puts_right
        named = dialogue.raised.object is not None
        if Expectation.IN_REACH in watched and named:
            return Expectation.IN_REACH
        for each in _WITHOUT_OBJECT:
            if each in watched:
                return each
        if Expectation.AT_PLACE in watched and named and dialogue.raised.place is not None:
            return Expectation.AT_PLACE
        return None

    def _expected_first(self, dialogue: DialogueState) -> Expectation | None:
        """What the first look is asked to wait for; of what was felt it sees whether it is seen."""
        felt = dialogue.raised.detection is not None and dialogue.raised.detection.felt
        return Expectation.WAY_CLEAR if felt else self._expected(dialogue)

    # --- What a look saw ----------------------------------------------------------------------

    def first_look(
        self, dialogue: DialogueState, proxy: RobotProxy, fulfilled: bool
    ) -> LookOutcome:
        """What the first look saw: everything later is compared with it."""
        seen = self._seen(dialogue, proxy, self._expected_first(dialogue) if fulfilled else None)
        first = replace(seen, brought=proxy.brought)
        if proxy.held is None or proxy.held != dialogue.raised.object:
            return first
        return replace(first, fulfilled=first.fulfilled | {Expectation.IN_GRIPPER})

    def right_at_first(self, dialogue: DialogueState, first: LookOutcome) -> PutRight | None:
        """What the first look saw of that which is known not to have been so before it."""
        conversation = dialogue.conversation
        watched = conversation.watched_for
        brought = brought_before(watched, first)
        return brought or contradiction(watched, conversation.contradictable, first)

    def put_right(
        self, dialogue: DialogueState, proxy: RobotProxy, fulfilled: bool
    ) -> PutRight | None:
        """Whether a look saw the issue put right since the question was put."""
        base = self._base(dialogue)
        if base is None or self.awaits_view(dialogue):
            return None
        now = self._seen(dialogue, proxy, self._expected(dialogue) if fulfilled else None)
        return put_right(dialogue.conversation.watched_for, base, now)

    def undone(
        self, dialogue: DialogueState, proxy: RobotProxy, fulfilled: bool
    ) -> LookOutcome | None:
        """A look that saw what was right to be so no more: now it can be put right again."""
        base = self._base(dialogue)
        now = self._seen(dialogue, proxy, self._expected(dialogue) if fulfilled else None)
        if base is None or now.blind or now.fulfilled:
            return None
        return now if _is_elsewhere(base.position, now.position) else None

    def change_seen(self, dialogue: DialogueState, proxy: RobotProxy, helped_with: Help) -> Change:
        """What a look that saw the promised help saw to change."""
        if helped_with is Help.TELL_PLACE:
            return Change.TOLD
        base = self._base(dialogue)
        if helped_with is Help.HAND_OVER:
            held_before = base is not None and Expectation.IN_GRIPPER in base.fulfilled
            return Change.NONE if held_before else Change.HANDED_OVER
        now = self._seen(dialogue, proxy, EXPECTED[helped_with])
        known = self._known_before(dialogue, EXPECTED[helped_with])
        change = change_since([*known, *self._earlier(dialogue)], now)
        untold = change is Change.NONE and dialogue.promised_first and not known
        return Change.UNKNOWN if untold else change

    def _known_before(self, dialogue: DialogueState, expected: Expectation) -> list[LookOutcome]:
        """What was known before the first look, when people may have begun to help already."""
        first, raised = dialogue.first_look, dialogue.raised
        known = [] if first is None else [known_before(first.outcome)]
        if dialogue.promised_first:
            untouched_at = None if raised.step else raised.last_seen
            known.append(known_when_raised(expected, dialogue.conversation.denied, untouched_at))
        return [each for each in known if each is not None]

    def _base(self, dialogue: DialogueState) -> LookOutcome | None:
        """What a look is compared with to see whether anything is right that was not."""
        return next(reversed(self._earlier(dialogue)), None)

    def _earlier(self, dialogue: DialogueState) -> list[LookOutcome]:
        """The first look, unless it was dark and another saw more, and the latest one anew."""
        first, later = dialogue.first_look, dialogue.looked_anew
        looks = []
        if first is not None and not (first.blind and later is not None):
            looks.append(first.outcome)
        if later is not None:
            looks.append(LookOutcome(frozenset(later.fulfilled), later.position))
        return looks

    def _seen(
        self, dialogue: DialogueState, proxy: RobotProxy, expected: Expectation | None
    ) -> LookOutcome:
        if proxy.led_round and expected is Expectation.WAY_CLEAR:
            expected = Expectation.LED_ROUND
        fulfilled = set() if expected is None else {expected}
        if self.is_at_place(dialogue, proxy):
            fulfilled.add(Expectation.AT_PLACE)
        if proxy.blind is not None:
            return LookOutcome(frozenset(fulfilled), None, blind=True)
        return LookOutcome(frozenset(fulfilled), seen_at(proxy, dialogue.raised.object))

    def is_at_place(self, dialogue: DialogueState, proxy: RobotProxy) -> bool:
        """Whether the last look saw the object at the place where it is to go."""
        return any(each in proxy.there for each in _result_of(dialogue))


def _result_of(dialogue: DialogueState) -> list[FinishedResult]:
    """What there is to see once the leaf is done, if it has an object and a place."""
    handled, place = dialogue.raised.object, dialogue.raised.place
    if handled is None or place is None:
        return []
    return [FinishedResult(object=handled, place=place)]


def seen_at(proxy: RobotProxy, name: str | None) -> Point | None:
    """Where a robot's last look saw an object, None if it did not."""
    seen = proxy.seen.get(name or "")
    return None if seen is None else (seen.x, seen.y, seen.z)


def _is_elsewhere(before: Point | None, now: Point | None) -> bool:
    if before is None or now is None:
        return before is not now
    return has_moved(before, now)
