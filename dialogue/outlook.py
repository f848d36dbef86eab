"""The outlook of an attempt: which one it is, and what a run does next, in plain words."""

from dataclasses import dataclass, field
from enum import StrEnum

from mend.dialogue.spoken import choice_of, count_of
from mend.dialogue.worded import Worded, worded


class Next(StrEnum):
    """What a run does next once a leaf has been put back."""

    TRY_AGAIN = "try_again"
    """The same leaf again."""
    OTHERS_FIRST = "others_first"
    """Other leaves go first, then the same one again."""
    INSTEAD = "instead"
    """Another alternative is taken; the leaf may never be tried again."""
    EITHER = "either"
    """The leaf or another alternative, whichever is nearer."""
    ANY_OF = "any_of"
    """The leaf or others that have failed as often, whichever is nearer."""
    RUN_FAILS = "run_fails"
    """Nothing is left to try: the run ends unfinished."""


@dataclass(frozen=True, slots=True)
class Sequel:
    """What comes next; `names` are the parts (or leaves) that go first or are taken instead.

    Each is named once; what a part's name alone does not tell apart has its place with it.
    """

    next: Next = Next.TRY_AGAIN
    names: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Outlook:
    """What the state of a run says about an attempt at a leaf that has met an issue.

    `attempt` of `attempts`: one more than have failed, and how many may. `failed` and `helped` say
    what follows if it fails, and if the robot is helped to another try. `times`: how often this
    kind of issue has come at this leaf; `unchanged`: the last so many of them with nothing seen to
    change in between. `helped_out`: the robot was helped to as many tries as there may be.
    `alone`: no other robot could take the leaf. `begins_anew`: the robot has lost what it was
    doing, and cannot go on where it was.
    """

    attempt: int = 1
    attempts: int = 3
    failed: Sequel = field(default_factory=Sequel)
    helped: Sequel = field(default_factory=Sequel)
    times: int = 1
    unchanged: int = 1
    helped_out: bool = False
    alone: bool = True
    begins_anew: bool = False

    @property
    def own_failure(self) -> bool:
        """Whether one more try of the same kind is not worth offering."""
        last = self.attempt >= self.attempts
        return self.helped_out or self.unchanged >= 3 or (last and self.times > 1)

    @property
    def may_be_left(self) -> bool:
        """Whether a helper who refuses is asked to have the leaf left out."""
        return self.attempt > 1 or self.times > 1 or self.failed.next is Next.RUN_FAILS

    @property
    def attempt_spoken(self) -> Worded:
        """Which attempt it is: `attempt 1 of 3`."""
        return self._attempt("attempt {attempt} of {attempts}", self.attempt)

    @property
    def times_spoken(self) -> Worded:
        """How often this kind of issue has come: `twice`, `three times`."""
        return count_of(self.times)

    def if_it_fails(self) -> Worded:
        """What is done next if this attempt fails, as a clause."""
        next_one = self._attempt("attempt {attempt} of {attempts}", self.attempt + 1)
        return self._clause(self.failed, next_one)

    def after_help(self) -> Worded:
        """What is done next if the robot is helped to another try, as a clause."""
        if self.helped_out:
            return self.if_it_fails()
        same_one = self._attempt("still attempt {attempt} of {attempts}", self.attempt)
        return self._clause(self.helped, same_one)

    def going_on(self) -> Worded:
        """What is done next once the issue is put right, as a clause."""
        return self.after_help() if self.begins_anew else worded("I go on")

    def _attempt(self, key: str, attempt: int) -> Worded:
        return worded(key, attempt=str(attempt), attempts=str(self.attempts))

    def _clause(self, sequel: Sequel, which: Worded) -> Worded:
        again = worded(self._again, which=which)
        names = choice_of(sequel.names)
        match sequel.next:
            case Next.TRY_AGAIN:
                return again
            case Next.OTHERS_FIRST:
                return worded(self._others_first, names=names, which=which)
            case Next.INSTEAD:
                return worded("I take {names} instead", names=names)
            case Next.EITHER:
                return worded("{again}, or I take {names} instead", again=again, names=names)
            case Next.ANY_OF:
                return worded(
                    "{again}, or I go on with {names} before that", again=again, names=names
                )
            case Next.RUN_FAILS:
                return worded("the task ends here, unfinished")

    @property
    def _again(self) -> str:
        return "I try again ({which})" if self.alone else "one of us tries again ({which})"

    @property
    def _others_first(self) -> str:
        return f"I go on with {{names}} first, then {self._again}"
