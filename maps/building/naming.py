"""Names that nothing else has, so that whoever hears one knows what is meant."""

from collections import Counter
from collections.abc import Callable, Container, Mapping
from itertools import chain, count

from mend.maps.building.building import BuildingDocument, Door

LONGEST = 64
"""So many characters a name has at most."""
_MOST_NAMED = 5


def plain_name(text: str) -> str:
    """As much of a text as a name may have, in words; empty where that is nothing.

    Without what stands between a floor and a place, and what cannot be seen.
    """
    seen = "".join(c for c in text.replace("/", "-") if c.isprintable() or c.isspace())
    return _cut(" ".join(seen.split()), LONGEST)


def unlike(name: str, others: Container[str], heard: Callable[[str], str] = str) -> str:
    """The name, or one with a number where others are `heard` alike."""
    tries = (f"{_cut(name, LONGEST - 1 - len(str(number)))}_{number}" for number in count(2))
    return next(each for each in chain([_cut(name, LONGEST)], tries) if heard(each) not in others)


def _cut(name: str, longest: int) -> str:
    return name[:longest].rstrip()


def with_plain_door_names(document: BuildingDocument, notes: list[str]) -> BuildingDocument:
    """With doors of which no two are called alike, on whichever floors, nor like an elevator.

    A robot says which door is shut by its name alone. Who hears a name does not hear capitals.
    """
    elevators = {name.casefold() for name in document.elevators}
    doors = Counter(name.casefold() for floor in document.floors.values() for name in floor.doors)
    floors = {}
    taken = {*elevators, *(name for name, times in doors.items() if times == 1)}
    for floor, each in document.floors.items():
        names: dict[str, str] = {}
        for name in each.doors:
            plain = name.casefold()
            if doors[plain] > 1 or plain in elevators:
                names[name] = _of_its_own(name, floor, plain in elevators, taken)
        if names:
            notes.append(_told(floor, names))
        renamed: dict[str, Door] = {names.get(k, k): door for k, door in each.doors.items()}
        floors[floor] = each.model_copy(update={"doors": renamed})
    return document.model_copy(update={"floors": floors})


def _of_its_own(name: str, floor: str, is_elevators: bool, taken: set[str]) -> str:
    """A name that says more, and that is taken from now on."""
    longer = f"{floor} {name} door" if is_elevators else f"{floor} {name}"
    called = unlike(longer, taken, str.casefold)
    taken.add(called.casefold())
    return called


def _told(floor: str, names: Mapping[str, str]) -> str:
    shown = [f"'{name}' is called '{called}'" for name, called in names.items()]
    more = ", ..." if len(shown) > _MOST_NAMED else ""
    return (
        f"floor '{floor}': doors are called like others, or like an elevator: "
        f"{', '.join(shown[:_MOST_NAMED])}{more} here"
    )
