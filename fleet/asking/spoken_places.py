"""The places of a building as people say them: "room three oh five", "101 on the first floor"."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from mend.fleet.asking.number_words import in_digits, ordinal

_FILLING = ("the", "room", "office", "number")
_FLOOR = ("floor", "level")
_MOST_TOLD = 3


@dataclass(frozen=True, slots=True)
class NoPlace:
    """Words that are no place, or that are several; `question` asks for the right ones."""

    question: str
    several: bool = False


class SpokenPlaces:
    """What words mean among places that are called `FLOOR/PLACE`."""

    def __init__(self, names: Sequence[str]) -> None:
        self._names = frozenset(names)
        self._plain: dict[str, list[str]] = {}
        self._keys: dict[str, set[str]] = {}
        floors = dict.fromkeys(name.partition("/")[0] for name in names)
        numbers = [each for floor in floors if (each := _number_in(floor)) is not None]
        called = {floor: list(_floor_keys(floor, numbers)) for floor in floors}
        for name in names:
            floor, _, place = name.partition("/")
            self._plain.setdefault(_spaced(name), []).append(name)
            for key in _place_keys(_key(place), called[floor]):
                self._keys.setdefault(key, set()).add(name)

    def meant(self, words: str) -> str | NoPlace:
        """The place that is meant, as `FLOOR/PLACE`."""
        exactly = [words] if words in self._names else self._plain.get(words, [])
        found = exactly or sorted(self._keys.get(_key(words), ()))
        if len(found) == 1:
            return found[0]
        if not found:
            return NoPlace(f"I know no place called “{words}” here: which place do you mean?")
        told = [self.said(each) for each in found[:_MOST_TOLD]]
        if len(found) > _MOST_TOLD:
            told = [*told[:-1], f"one of {len(found) - len(told) + 1} others"]
        several = f"{', '.join(told[:-1])} or {told[-1]}"
        return NoPlace(f"There are several places called “{words}”: do you mean {several}?", True)

    def said(self, name: str) -> str:
        """How a place is read back, so that it is meant again."""
        spaced = _spaced(name)
        return spaced if len(self._plain.get(spaced, ())) == 1 else name


def _spaced(name: str) -> str:
    return name.replace("/", " ")


def _key(words: str) -> str:
    """Words without what is only said along, numbers in digits, as they are compared."""
    split = re.findall(r"[0-9]+|[^\W0-9_]+", _with_ordinals(words.casefold()))
    told = [each for each in split if each not in _FILLING] or split
    return " ".join(in_digits(told))


def _with_ordinals(words: str) -> str:
    """ "first floor" as "floor 1"."""
    said = words.split()
    for at, word in enumerate(said[1:], start=1):
        number = ordinal(said[at - 1])
        if word in _FLOOR and number is not None:
            said[at - 1 : at + 1] = [word, number]
    return " ".join(said)


def _number_in(floor: str) -> str | None:
    found = re.findall(r"[0-9]+", floor)
    return found[0] if len(found) == 1 else None


def _floor_keys(floor: str, numbers: Sequence[str]) -> Iterator[str]:
    number = _number_in(floor)
    key = _key(floor)
    yield key
    for word in _FLOOR:
        yield f"{key} {word}"
        yield f"{word} {key}"
        if number is not None and number != key and numbers.count(number) == 1:
            yield f"{word} {number}"


def _place_keys(place: str, floors: Sequence[str]) -> Iterator[str]:
    """A place alone, after its floor, or "on" it."""
    yield place
    for floor in floors:
        # Digits beside each other are one number to whoever hears them.
        yield f"{floor}{_between(floor, place)}{place}"
        yield f"{place} on {floor}"


def _between(left: str, right: str) -> str:
    return "" if left[-1:].isdigit() and right[:1].isdigit() else " "
