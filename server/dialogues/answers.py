"""Where a run's answers come from: a script, chance, nobody, or live helpers.

Asks are counted over a run, each repetition of a question as one more, so that a run folded again
from the journal goes on with the answer that it would have had.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from mend.server.runtime.requests import RunRequest
from mend.tasks.scenario import Scenario

DEFAULT_DELAY_S = 2.0
RANDOM_DELAY_S = (0.5, 6.0)
"""Within which a random answer comes, uniformly."""
RANDOM_SHARES: dict[Literal["yes", "no"] | None, float] = {"yes": 0.6, "no": 0.25, None: 0.15}
"""How often a random answer is yes, no, or none at all."""


@dataclass(frozen=True, slots=True)
class ScriptedAnswer:
    """What is answered, `delay_s` after the question on the run's clock; None is silence."""

    answer: Literal["yes", "no"] | None
    delay_s: float = 0.0


SILENCE = ScriptedAnswer(None)


class AnswerSource(Protocol):
    """Answers for one run."""

    @property
    def live(self) -> bool:
        """Whether helpers answer, so that the clock may not run ahead of them."""
        ...

    def next_answer(self, ask: int) -> ScriptedAnswer:
        """The answer to the run's `ask`-th ask; the first is 1."""
        ...


@dataclass(frozen=True, slots=True)
class ListedAnswers:
    """Answers in turn; where they run out, silence follows."""

    answers: Sequence[Literal["yes", "no", "silence"]]
    delay_s: float = DEFAULT_DELAY_S
    live: bool = False

    def next_answer(self, ask: int) -> ScriptedAnswer:
        if ask > len(self.answers):
            return SILENCE
        answer = self.answers[ask - 1]
        return SILENCE if answer == "silence" else ScriptedAnswer(answer, self.delay_s)


@dataclass(frozen=True, slots=True)
class RandomAnswers:
    """Answers by chance; each depends on the seed and its number alone."""

    seed: int
    live: bool = False

    def next_answer(self, ask: int) -> ScriptedAnswer:
        chance = np.random.default_rng((self.seed, ask))
        drawn = chance.choice(len(RANDOM_SHARES), p=list(RANDOM_SHARES.values()))
        delay_s = float(chance.uniform(*RANDOM_DELAY_S))
        answer = list(RANDOM_SHARES)[int(drawn)]
        return SILENCE if answer is None else ScriptedAnswer(answer, delay_s)


@dataclass(frozen=True, slots=True)
class NoAnswers:
    """Nobody ever answers of themselves; `live` says whether helpers may."""

    live: bool

    def next_answer(self, ask: int) -> ScriptedAnswer:  # noqa: ARG002 - part of the protocol
        return SILENCE


def answer_source(request: RunRequest, scenario: Scenario | None) -> AnswerSource:
    """The source that a request and its scenario ask for; the request's answers come first."""
    delay_s = scenario.answer_delay_s if scenario else DEFAULT_DELAY_S
    match request.answers:
        case "random":
            return RandomAnswers(request.seed)
        case "none":
            return NoAnswers(live=False)
        case "live":
            return NoAnswers(live=True)
        case list(answers):
            return ListedAnswers(tuple(answers), delay_s)
    if scenario is not None and scenario.answers:
        return ListedAnswers(tuple(scenario.answers), delay_s)
    return NoAnswers(live=True)
