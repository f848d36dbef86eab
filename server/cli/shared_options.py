"""Options that several commands have, each told once, as the fields of a dataclass."""

import inspect
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import wraps
from typing import Any, TypeVar, get_type_hints

T = TypeVar("T")


def with_shared_options(command: Callable[..., T]) -> Callable[..., T]:
    """Have a command take the fields of each parameter that is a dataclass as options.

    They come in the order of the parameters. The names of all have to differ.
    """
    hints = get_type_hints(command)
    shared: dict[str, Any] = {name: each for name, each in hints.items() if is_dataclass(each)}
    signature = inspect.signature(command)

    @wraps(command)
    def spread(**given: Any) -> T:
        for name, kind in shared.items():
            given[name] = kind(**{each.name: given.pop(each.name) for each in fields(kind)})
        return command(**given)

    parameters: list[inspect.Parameter] = []
    for name, parameter in signature.parameters.items():
        parameters += _parameters_of(shared[name]) if name in shared else [parameter]
    # What typer reads, instead of what the command itself is written with.
    spread.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    spread.__annotations__ = {each.name: each.annotation for each in parameters}
    del spread.__wrapped__
    return spread


def _parameters_of(kind: Any) -> list[inspect.Parameter]:
    hints = get_type_hints(kind, include_extras=True)
    return [
        inspect.Parameter(
            each.name,
            inspect.Parameter.KEYWORD_ONLY,
            default=each.default,
            annotation=hints[each.name],
        )
        for each in fields(kind)
    ]
