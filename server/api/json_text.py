"""JSON as the standard has it: no NaN, no infinity, no nesting without end, not without end."""

import json
import math
from collections.abc import Iterable
from typing import Any, NoReturn

from mend.errors import MendError


class NotJsonError(MendError):
    """What was sent is not JSON, or cannot be read; the message is one clear sentence."""


class TooManyValuesError(MendError):
    """What was sent has more values than anybody may send; the message says how many that is."""


def may_have(body: bytes, values: int) -> bool:
    """Whether JSON may have more than so many values, as far as its punctuation tells."""
    return body.count(b",") + body.count(b"[") + body.count(b"{") >= values


def read_json(body: bytes, most_values: int) -> Any:
    """What a body says, in at most so many values.

    Raises `JSONDecodeError`, `NotJsonError` and `TooManyValuesError`.
    """
    try:
        read = json.loads(body.decode("utf-8"), parse_constant=_refuse, parse_float=_finite)
    except json.JSONDecodeError:
        raise
    except UnicodeDecodeError as error:
        raise NotJsonError(f"the body is not UTF-8: byte {error.start} is wrong") from None
    except RecursionError:
        raise NotJsonError("the body has lists or objects too deep within each other") from None
    except ValueError as error:
        raise NotJsonError(f"the body cannot be read: {error}") from None
    if may_have(body, most_values) and _values(read) > most_values:
        raise TooManyValuesError(f"the body has too many values: it may have {most_values}")
    return read


def _values(read: Any) -> int:
    count, waiting = 0, [read]
    while waiting:
        each = waiting.pop()
        count += 1
        inner: Iterable[Any] = ()
        if isinstance(each, dict):
            inner = each.values()
        elif isinstance(each, list):
            inner = each
        waiting.extend(inner)
    return count


def _refuse(constant: str) -> NoReturn:
    raise ValueError(f"{constant} is not JSON")


def _finite(number: str) -> float:
    value = float(number)
    if math.isinf(value):
        raise ValueError("a number is too large")
    return value
