"""Building files: reading, checking and writing them."""

import json
import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from mend.documents.document import DocumentError, LinedMapping, read_document, read_text
from mend.documents.kinds_of_files import not_the_kind
from mend.documents.problem import InvalidFileError, Problem, list_names
from mend.documents.validation import find_line, show_kind, validate_part
from mend.maps.building.building import Building, BuildingDocument, Floor
from mend.maps.building.connection import connected, usable

Location = tuple[str | int, ...]
Mistake = tuple[Location, str]
"""Where in the document, and a sentence."""


class BuildingFileError(InvalidFileError):
    """A building file has mistakes."""


def read_building_file(path: Path) -> Building:
    """Read and check a building file (YAML or JSON). Raises `BuildingFileError`."""
    try:
        text = read_text(path)
    except DocumentError as error:
        raise BuildingFileError(str(path), [error.problem]) from error
    return read_building_text(text, source=str(path))


def read_building_text(text: str, *, source: str = "building") -> Building:
    """Check the text of a building file; `source` names it. Raises `BuildingFileError`."""
    try:
        content, problems = read_document(text)
    except DocumentError as error:
        raise BuildingFileError(source, [error.problem]) from error
    if not isinstance(content, LinedMapping):
        message = f"a building file is a mapping, but this is {show_kind(content)}"
        raise BuildingFileError(source, [*problems, Problem(1, None, message)])
    if other := not_the_kind(content, "a building"):
        raise BuildingFileError(source, [other])
    document, wrong = validate_part(BuildingDocument, content)
    problems += wrong
    if document is not None:
        found = check_building(document)
        problems += [Problem(find_line(content, at), None, message) for at, message in found]
    if document is None or problems:
        raise BuildingFileError(source, problems)
    return Building(document)


def check_building(document: BuildingDocument) -> list[Mistake]:
    """What keeps robots from driving through a building as it says; empty where nothing does."""
    mistakes = [each for name, floor in document.floors.items() for each in _of_floor(name, floor)]
    mistakes += [*_of_heights(document), *_of_elevators(document)]
    if mistakes:
        return mistakes
    building = Building(document)
    return [*_walls_crossed(building), *_unreachable(building)]


def building_text(document: BuildingDocument) -> str:
    """A building as YAML, a line for a place, a lane or a wall."""
    return document_text(document.model_dump(mode="json", exclude_defaults=True))


def document_text(plain: dict[str, Any]) -> str:
    """A mapping as YAML: what is short in one line, everything else in a line of its own."""
    return "\n".join([*_lines(plain, 0), ""])


def _of_floor(name: str, floor: Floor) -> Iterator[Mistake]:
    at: Location = ("floors", name)
    if not floor.places:
        yield at, f"the floor '{name}' has no place where a robot could be"
    for number, lane in enumerate(floor.lanes):
        where = (*at, "lanes", number)
        missing = [each for each in lane.between if each not in floor.places]
        if missing:
            yield (
                where,
                f"this floor has no place '{missing[0]}'; it has {list_names(floor.places)}",
            )
        elif lane.between[0] == lane.between[1]:
            yield where, f"a lane from '{lane.between[0]}' to itself leads nowhere"
    for number, earlier in floor.lanes_twice().items():
        a, b = floor.lanes[number].between
        told = f"the lane from '{a}' to '{b}' is there already: it is lane {earlier}"
        yield (*at, "lanes", number), told
    for number, (x0, y0, x1, y1) in enumerate(floor.walls):
        if (x0, y0) == (x1, y1):
            yield (*at, "walls", number), f"the wall begins and ends at ({x0:g}, {y0:g})"
    yield from _of_doors(at, floor)


def _of_doors(at: Location, floor: Floor) -> Iterator[Mistake]:
    there: dict[frozenset[tuple[float, float]], str] = {}
    for door, each in floor.doors.items():
        where = (*at, "doors", door)
        if each.posts[0] == each.posts[1]:
            yield where, f"the posts of the door '{door}' are in one place"
        elif (other := there.setdefault(frozenset(each.posts), door)) != door:
            yield where, f"the door '{door}' is where the door '{other}' is"
        if any(not opens < shuts for opens, shuts in each.open_s):
            yield where, f"the door '{door}' shuts before it opens"


def _of_heights(document: BuildingDocument) -> Iterator[Mistake]:
    for (below, low), (name, floor) in pairwise(document.floors.items()):
        if floor.height < low.height:
            yield (
                ("floors", name, "height"),
                f"floors come from the lowest to the highest, but '{name}' is at "
                f"{floor.height:g} m and '{below}' before it at {low.height:g} m",
            )


def _of_elevators(document: BuildingDocument) -> Iterator[Mistake]:
    taken: dict[tuple[str, str], str] = {}
    for name, elevator in document.elevators.items():
        for floor, place in elevator.stops.items():
            where: Location = ("elevators", name, "stops", floor)
            if (other := taken.setdefault((floor, place), name)) != name:
                yield where, f"the elevator '{other}' stops at '{floor}/{place}' already"
            if floor not in document.floors:
                yield where, f"there is no floor '{floor}'; there are {list_names(document.floors)}"
            elif place not in document.floors[floor].places:
                yield (
                    where,
                    f"the elevator '{name}' stops at '{place}', which the floor '{floor}' has not",
                )


def _walls_crossed(building: Building) -> Iterator[Mistake]:
    for each in building.crossings:
        if len(each.walls):
            lanes = building.floors[each.floor].lanes
            where = ("floors", each.floor, "lanes", lanes.index(each.lane))
            a, b = each.lane.between
            yield (
                where,
                f"the lane between '{a}' and '{b}' goes through a wall that has no door there",
            )


def _unreachable(building: Building) -> Iterator[Mistake]:
    """Places that cannot be reached from the first one, or that nobody gets away from."""
    graph = building.graph
    labels, fits = connected(graph), usable(graph)
    largest = int(np.bincount(labels).argmax())
    for number in np.flatnonzero(~fits).tolist():
        full = graph.places[number].name
        floor, place = full.split("/", 1)
        where: Location = ("floors", floor, "places", place)
        if labels[number] == largest:
            yield where, f"no lane leads to '{full}' and back from the rest of its floor"
        else:
            inside = graph.places[int(np.flatnonzero(labels == largest)[0])].name
            yield where, f"no way leads from '{inside}' to '{full}' and back"


_IN_ONE_LINE = 100
_PLAIN = re.compile(r"(?!true|false|null)[A-Za-z_][A-Za-z0-9_-]*", re.IGNORECASE)
"""Keys that are text without quotation marks."""


def _lines(value: dict[str, Any], depth: int) -> Iterator[str]:
    indent = "  " * depth
    for key, each in value.items():
        name = key if _PLAIN.fullmatch(key) else json.dumps(key, ensure_ascii=False)
        flow = json.dumps(each, ensure_ascii=False)
        if len(flow) <= _IN_ONE_LINE or not each or not isinstance(each, dict | list):
            yield f"{indent}{name}: {flow}"
        elif isinstance(each, dict):
            yield f"{indent}{name}:"
            yield from _lines(each, depth + 1)
        else:
            yield f"{indent}{name}:"
            yield from (f"{indent}  - {json.dumps(item, ensure_ascii=False)}" for item in each)
