"""What a fault monitor is, whatever body it watches."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any, ClassVar, Generic, TypeVar

from mend.documents.strict_model import StrictModel
from mend.robots.body import CameraImage
from mend.robots.execution.phase import Phase
from mend.robots.link.messages import Detection

BEFORE_FIRST_STEP = 0

ANY_BEHAVIOR: frozenset[str] = frozenset({"*"})
"""Names every behavior: for what no behavior can go on without."""


class NoParameters(StrictModel):
    """The settings of a monitor that has none."""


class Reaction(StrEnum):
    """What the robot does once the issue is raised."""

    GO_TO_NEUTRAL = "go_to_neutral"
    """It stops, lets go, moves to neutral and holds."""
    STOP_IN_PLACE = "stop_in_place"
    """It stops where it is, before the first step at rest, and holds."""
    SLOW_DOWN = "slow_down"
    """It goes on, slowly, until the behavior's last step is done."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MonitorView:
    """What any robot senses at one moment; nothing in it comes from a simulator.

    `step` counts from 1 and is 0 before the first; `phase` is what it is for. `pictures` are those
    that the rest was seen in, by camera.
    """

    time_s: float
    step: int
    phase: Phase
    pictures: Mapping[str, CameraImage] = field(default_factory=dict)


P = TypeVar("P", bound=StrictModel)
V = TypeVar("V", bound=MonitorView)


class Monitor(ABC, Generic[P, V]):
    """Watches one execution for one kind of issue; a package adds its own by an entry point.

    It derives from the kind of its body (`ArmMonitor`, `BaseMonitor`), or from this one with
    `MonitorView` where it watches any. `view` is what it is shown. `issue` is the kind, under which
    dialogue scripts are registered too. It checks in the `phases` of the `behaviors` that it names
    (a behavior says in `monitored_as` by which name it is watched), at the period of its body, and
    never in any other. `camera` is the one whose pictures it judges, None if it judges by something
    else. `parameters` is the pydantic model of its settings. A monitor is made anew for each
    execution, so it may remember what it saw.
    """

    view: ClassVar[type[MonitorView]] = MonitorView
    issue: ClassVar[str]
    behaviors: ClassVar[frozenset[str]]
    phases: ClassVar[frozenset[Phase]]
    reaction: ClassVar[Reaction]
    camera: ClassVar[str | None] = None
    parameters: ClassVar[type[StrictModel]]

    def __init__(self, settings: P) -> None:
        self.settings = settings

    @classmethod
    def create(cls, parameters: Mapping[str, Any]) -> "Monitor[Any, Any]":
        """Make one from a mapping. Raises pydantic's `ValidationError` for wrong parameters."""
        return cls(cls.parameters.model_validate(parameters))  # type: ignore[arg-type]

    @property
    def interrupts(self) -> bool:
        """Whether the behavior does not simply go on."""
        return self.reaction is not Reaction.SLOW_DOWN

    def watches(self, behavior: str, phase: Phase) -> bool:
        """Whether it checks in this phase of what is monitored as this behavior."""
        named = behavior in self.behaviors or self.behaviors == ANY_BEHAVIOR
        return named and phase in self.phases

    @abstractmethod
    def check(self, view: V) -> Detection | None:
        """What it detected, or None if all is as it must be."""


AnyMonitor = Monitor[Any, Any]


def for_view(
    monitors: Iterable[type[AnyMonitor]], view: type[MonitorView]
) -> list[type[AnyMonitor]]:
    """Those that can judge by such a view."""
    return [each for each in monitors if issubclass(view, each.view)]
