"""A behavior: a name and a model of its parameters; what its steps are its kind of body says."""

from abc import ABC
from collections.abc import Mapping
from typing import ClassVar, TypeVar

from pydantic import ValidationError

from mend.documents.strict_model import StrictModel
from mend.robots.execution.command_error import CommandError
from mend.robots.link.messages import Start


class Behavior(ABC):
    """One kind of behavior. A package adds its own under the entry point `mend.behaviors`.

    It derives from the kind of its body: `mend.robots.arm.behaviors.ArmBehavior`, or
    `mend.robots.base.behaviors.BaseBehavior`. `parameters` is the pydantic model of its parameters
    in task files and commands. `monitored_as` is the behavior whose monitors watch it: its own name
    unless it says otherwise. `step_count` is how many steps it always has; None where that depends
    on its parameters or on the situation.
    """

    name: ClassVar[str]
    parameters: ClassVar[type[StrictModel]]
    monitored_as: ClassVar[str]
    step_count: ClassVar[int | None] = None

    def __init_subclass__(cls, **given: object) -> None:
        super().__init_subclass__(**given)
        if not hasattr(cls, "monitored_as") and hasattr(cls, "name"):
            cls.monitored_as = cls.name


K = TypeVar("K", bound=Behavior)


def of_kind(behaviors: Mapping[str, type[Behavior]], kind: type[K]) -> dict[str, type[K]]:
    """Those that are for one kind of body."""
    return {name: each for name, each in behaviors.items() if issubclass(each, kind)}


def read_parameters(behavior: type[Behavior], start: Start) -> StrictModel:
    """The parameters of a start command. Raises `CommandError`."""
    try:
        return behavior.parameters.model_validate(start.parameters)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(each) for each in first["loc"]) or "parameters"
        raise CommandError(f"{start.behavior}: {where}: {first['msg']}") from error
