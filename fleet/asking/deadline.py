"""By when something is wanted, as people say it: "by three o'clock", "within ten minutes"."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from mend.fleet.asking.number_words import in_digits

DAY_MIN = 24 * 60
_HALF_DAY_MIN = DAY_MIN // 2
_BY, _WITHIN = ("by", "before"), ("within", "in")
BEGINS = (*_BY, *_WITHIN)
"""With these words a deadline begins."""
_HOUR = ("hour", "hours", "h")
_MINUTE = ("minute", "minutes", "min")
_PARTS = {"half": "30", "quarter": "15"}
_NAMED = {"noon": _HALF_DAY_MIN, "midday": _HALF_DAY_MIN, "midnight": 0}
_LONGEST_WORDS = 7


@dataclass(frozen=True, slots=True)
class By:
    """By a time of the day: minutes since midnight; of today, unless that is over, or `tomorrow`.

    Where it is known how late it is, `tomorrow` says so also of what is over today.
    """

    minute: int
    tomorrow: bool = False


@dataclass(frozen=True, slots=True)
class Within:
    """Within so many minutes from now."""

    minutes: int


Deadline = By | Within


@dataclass(frozen=True, slots=True)
class TwoTimes:
    """A time that is there twice a day, where nothing tells which: nobody has said how late it is,
    or it is to be `tomorrow`."""

    minute: int
    tomorrow: bool = False

    @property
    def question(self) -> str:
        """Asks which of them."""
        day = " tomorrow" if self.tomorrow else ""
        late = clock(self.minute + _HALF_DAY_MIN)
        return f"Do you mean {clock(self.minute)}{day} or {late}{day}?"


def clock(minute: int) -> str:
    """A time of the day as on a clock of 24 hours."""
    return f"{minute // 60:02d}:{minute % 60:02d}"


def deadline_words(deadline: Deadline) -> str:
    """How it is read back, so that it is meant again."""
    if isinstance(deadline, By):
        return f"by {clock(deadline.minute)}{' tomorrow' if deadline.tomorrow else ''}"
    return f"within {deadline.minutes} {'minute' if deadline.minutes == 1 else 'minutes'}"


def minutes_left(deadline: Deadline, now_min: int) -> int:
    """How long that is from a time of the day (minutes since midnight); less than two days."""
    if isinstance(deadline, Within):
        return deadline.minutes
    if deadline.tomorrow:
        return deadline.minute + DAY_MIN - now_min
    return (deadline.minute - now_min - 1) % DAY_MIN + 1


def at_end(
    words: Sequence[str], now_min: int | None
) -> tuple[Sequence[str], Deadline | TwoTimes | None]:
    """The words before a deadline that ends them, and that deadline; None where there is none."""
    for at in range(max(1, len(words) - _LONGEST_WORDS), len(words) - 1):
        found = _deadline(words[at:], now_min)
        if found is not None:
            return words[:at], found
    return words, None


def at_start(
    words: Sequence[str], now_min: int | None
) -> tuple[Sequence[str], Deadline | TwoTimes | None]:
    """The words after a deadline that begins them, and that deadline."""
    for end in range(min(_LONGEST_WORDS, len(words) - 1), 1, -1):
        found = _deadline(words[:end], now_min)
        if found is not None:
            return words[end:], found
    return words, None


def _deadline(words: Sequence[str], now_min: int | None) -> Deadline | TwoTimes | None:
    first, *rest = _with_clocks([each.casefold().strip(",") for each in words])
    rest = [each.replace(".", "") if each in ("a.m.", "p.m.") else each for each in rest]
    if first in _WITHIN:
        return _within(rest)
    return _by_a_day(rest, now_min) if first in _BY else None


def _with_clocks(words: Sequence[str]) -> list[str]:
    """ "Three o clock" and "three oclock", as recognizers write them, are three o'clock."""
    told = " ".join(words).replace("’", "'")
    return re.sub(r"\bo[ ']?clock\b", "o'clock", told).split(" ")


def _within(words: Sequence[str]) -> Within | None:
    if list(words) == ["half", "an", "hour"]:
        return Within(30)
    told = ["1", *words[1:]] if words[:1] in (["a"], ["an"]) else in_digits(words)
    if len(told) != 2 or re.fullmatch("[0-9]{1,4}", told[0]) is None:
        return None
    factor = 60 if told[1] in _HOUR else 1 if told[1] in _MINUTE else 0
    minutes = int(told[0]) * factor
    return Within(minutes) if 0 < minutes <= DAY_MIN else None


def _by_a_day(words: Sequence[str], now_min: int | None) -> By | TwoTimes | None:
    """A time of today or tomorrow: whoever says "tomorrow" does not mean the next such time."""
    if words[-1:] == ["tomorrow"]:
        found = _by(words[:-1], None)
        return None if found is None else replace(found, tomorrow=True)
    is_today = words[-1:] == ["today"]
    found = _by(words[:-1] if is_today else words, now_min)
    if isinstance(found, By) and now_min is not None:
        tomorrow = found.minute <= now_min
        # What is over today cannot be meant.
        return None if tomorrow and is_today else By(found.minute, tomorrow=tomorrow)
    return found


def _by(words: Sequence[str], now_min: int | None) -> By | TwoTimes | None:
    if len(words) == 1 and words[0] in _NAMED:
        return By(_NAMED[words[0]])
    told = re.sub(r"(?<=[0-9])(?=[ap]m\b)", " ", " ".join(words)).split()
    half = told[-1:] if told[-1:] in (["am"], ["pm"]) else []
    minute = _minute(told[: len(told) - len(half)], alone=bool(half))
    if minute is None:
        return None
    is_late_hour = minute >= _HALF_DAY_MIN + 60 or minute < 60
    if half:
        late = _HALF_DAY_MIN if half == ["pm"] else 0
        return None if is_late_hour else By(minute % _HALF_DAY_MIN + late)
    if is_late_hour or re.fullmatch("[0-9]{2}:[0-9]{2}", told[0]):
        return By(minute)
    early = minute % _HALF_DAY_MIN
    if now_min is None:
        return TwoTimes(early)
    return By(min(early, early + _HALF_DAY_MIN, key=lambda each: (each - now_min - 1) % DAY_MIN))


def _minute(words: Sequence[str], *, alone: bool) -> int | None:
    """The minute of the day of "3:30", "three thirty", "half past three", "quarter to three" or
    "three o'clock", and, where it may stand `alone`, of "three"."""
    if "past" in words or "to" in words:
        return _beside_an_hour(words)
    if words[1:] == ["o'clock"] or (alone and len(words) == 1 and ":" not in words[0]):
        hour = _hour(words[:1])
        return None if hour is None else hour * 60
    if len(words) == 1:
        written = re.fullmatch("([0-9]{1,2}):([0-9]{2})", words[0])
        parts = list(written.groups()) if written is not None else []
    else:
        parts = [*in_digits(words[:1]), *in_digits(words[1:])]
        # "Three five" is more likely a room.
        parts = parts if len(parts) == 2 and re.fullmatch("[1-5][0-9]", parts[1]) else []
        parts = parts if all(each.isalpha() for each in words) else []
    hour = _hour(parts[:1])
    return None if hour is None or int(parts[1]) > 59 else hour * 60 + int(parts[1])


def _beside_an_hour(words: Sequence[str]) -> int | None:
    """The minute of the day of "half past three", "a quarter to three" or "ten past three"."""
    at = next(at for at, each in enumerate(words) if each in ("past", "to"))
    hour, before = _hour(words[at + 1 :]), words[at > 0 and words[0] == "a" : at]
    told = [_PARTS.get(each, each) for each in in_digits(before)]
    if hour is None or hour > 12 or len(told) != 1 or not re.fullmatch("[0-9]{1,2}", told[0]):
        return None
    minutes = int(told[0])
    if not 0 < minutes < 60 or (words[at] == "to" and (hour == 0 or before == ["half"])):
        return None
    return hour * 60 + minutes if words[at] == "past" else ((hour - 1) or 12) * 60 + 60 - minutes


def _hour(words: Sequence[str]) -> int | None:
    found = in_digits(words)
    is_hour = len(found) == 1 and re.fullmatch("[0-9]{1,2}", found[0]) and int(found[0]) < 24
    return int(found[0]) if is_hour else None
