"""Scenarios: scripted interventions, helper answers and a simulated person's reliability."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from mend.documents.strict_model import StrictModel
from mend.tasks.intervention import Intervention
from mend.tasks.scene import Name, Pose

Fraction = Annotated[float, Field(ge=0.0, le=1.0)]
Seconds = Annotated[float, Field(ge=0.0, le=3600.0)]
WEEK_S = 604_800.0


class Trigger(StrictModel):
    """A moment of task progress: `fraction` of a step of the behavior that handles `object`.

    `attempt` counts the starts of that behavior from 1.
    """

    object: Name
    step: Annotated[int, Field(ge=1, le=64)]
    fraction: Fraction = 0.0
    attempt: Annotated[int, Field(ge=1, le=1_000_000)] = 1


class ScriptedIntervention(StrictModel):
    """An intervention and when it happens: at a moment of task progress or at a time."""

    when: Trigger | None = None
    at_s: Annotated[float, Field(ge=0.0, le=WEEK_S)] | None = None
    do: Intervention

    @model_validator(mode="after")
    def _require_one_moment(self) -> Self:
        if (self.when is None) == (self.at_s is None):
            given = "neither" if self.when is None else "both"
            raise ValueError(f"an intervention needs 'when' or 'at_s' (got {given})")
        return self


class Person(StrictModel):
    """How a simulated person keeps the helper's promises.

    `delay_s` passes between promise and deed. The probabilities say how often, by the run's seed,
    the deed comes late (`late_s` more), with the wrong object, at a wrong place, or not at all.
    """

    acts: bool = True
    delay_s: Seconds = 3.0
    late: Fraction = 0.0
    late_s: Seconds = 60.0
    wrong_object: Fraction = 0.0
    wrong_place: Fraction = 0.0
    never: Fraction = 0.0


class Scenario(StrictModel):
    """A script for a run of `tree`.

    `scene` moves objects before the run begins. `answers` are given in turn, each `answer_delay_s`
    after its question; where they run out, silence follows.
    """

    name: Name
    tree: Name
    description: str = ""
    scene: dict[Name, Pose] = {}
    interventions: list[ScriptedIntervention] = []
    answers: list[Literal["yes", "no", "silence"]] = []
    answer_delay_s: Seconds = 2.0
    person: Person = Person()
