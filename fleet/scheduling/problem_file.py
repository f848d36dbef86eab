"""Delivery files: reading and checking them, and the problem that they pose."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import Any

import numpy as np

from mend.documents.document import DocumentError, LinedMapping, read_document, read_text
from mend.documents.problem import InvalidFileError
from mend.documents.problem import Problem as Mistake
from mend.documents.validation import find_line, show_kind, validate_part
from mend.errors import WrongInputError
from mend.fleet.scheduling.building_travel import travel_in
from mend.fleet.scheduling.delivery_building import find_building, in_building
from mend.fleet.scheduling.delivery_document import (
    DeliveryDocument,
    GraphEntry,
    ItemEntry,
    MatrixEntry,
    Span,
    TravelEntry,
    VisitEntry,
)
from mend.fleet.scheduling.delivery_references import find_mistakes, place_names
from mend.fleet.scheduling.infeasibility import infeasibilities
from mend.fleet.scheduling.problem import (
    Item,
    Problem,
    ProblemError,
    Robot,
    Transfers,
    Visit,
    Weights,
    Window,
)
from mend.fleet.scheduling.travel import Matrix, Travel, TravelError
from mend.maps.navigation import NavigationError, NavigationGraph, Place, Way

FLOOR_GAP = 0.25
"""How far floors are apart where they are drawn beside each other, as a share of their depth."""


class DeliveryFileError(InvalidFileError):
    """A delivery file has mistakes; raised by every function that reads one."""


@dataclass(frozen=True, slots=True)
class Delivery:
    """A delivery file without mistakes: its problem, and what makes it infeasible."""

    problem: Problem
    infeasibilities: tuple[Mistake, ...]


def read_delivery_file(path: Path) -> Delivery:
    """Read and check a delivery file (YAML or JSON). Raises `DeliveryFileError`."""
    try:
        text = read_text(path)
    except DocumentError as error:
        raise DeliveryFileError(str(path), [error.problem]) from error
    return read_delivery_text(text, source=str(path), folder=path.parent)


def read_delivery_text(
    text: str, *, source: str = "delivery", folder: Path | None = None
) -> Delivery:
    """Check the text of a delivery file; `source` names it.

    A building's file is looked for below `folder`. Raises `DeliveryFileError`.
    """
    try:
        content, mistakes = read_document(text)
    except DocumentError as error:
        raise DeliveryFileError(source, [error.problem]) from error
    if not isinstance(content, LinedMapping):
        message = f"a delivery file is a mapping, but this is {show_kind(content)}"
        raise DeliveryFileError(source, [*mistakes, Mistake(1, None, message)])
    document, wrong = validate_part(DeliveryDocument, content)
    mistakes += wrong
    if document is not None and document.travel.building is not None:
        document, wrong = _in_building(document, content, folder)
        mistakes += wrong
    if document is not None:
        mistakes += [
            Mistake(find_line(content, location), None, message)
            for location, message in find_mistakes(document)
        ]
    if document is None or mistakes:
        raise DeliveryFileError(source, mistakes)
    try:
        problem = problem_of(document)
    except (NavigationError, ProblemError) as error:
        told = [Mistake(content.line, None, message) for message in error.mistakes]
        raise DeliveryFileError(source, told) from error
    except TravelError as error:
        line = find_line(content, ("travel",))
        raise DeliveryFileError(source, [Mistake(line, None, str(error))]) from error
    return Delivery(problem, tuple(_infeasibilities(problem, content)))


def _in_building(
    document: DeliveryDocument, content: LinedMapping, folder: Path | None
) -> tuple[DeliveryDocument | None, list[Mistake]]:
    """The document with the graph of its building; None where that cannot be read."""
    assert document.travel.building is not None, "the document names a building"
    line = find_line(content, ("travel", "building", "file"))
    try:
        building = find_building(document.travel.building.file, folder)
    except WrongInputError as error:
        return None, [Mistake(line, None, each) for each in str(error).splitlines()]
    placed, wrong = in_building(document, building)
    return placed, [Mistake(find_line(content, at), None, message) for at, message in wrong]


def _infeasibilities(problem: Problem, content: LinedMapping) -> list[Mistake]:
    found = []
    for each in infeasibilities(problem):
        where = ("items", each.item) if each.item is not None else ("robots", each.robot or 0)
        found.append(Mistake(find_line(content, where), None, each.sentence))
    return found


def delivery_schema() -> dict[str, Any]:
    """The JSON Schema of a delivery file."""
    dialect = "https://json-schema.org/draft/2020-12/schema"
    return {"$schema": dialect, **DeliveryDocument.model_json_schema()}


# --- the problem ------------------------------------------------------------------------------


def problem_of(document: DeliveryDocument, *, whole: bool = False) -> Problem:
    """The problem that a document without mistakes poses.

    `whole`: with all places, also those where nothing happens, as a fleet at work needs them to be
    led around what is blocked. Raises `TravelError` where doors change too often.
    """
    names = place_names(document.travel) if whole else _places_needed(document)
    place = {name: number for number, name in enumerate(names)}
    robots = {robot.name: number for number, robot in enumerate(document.robots)}
    transfers, weights = document.transfers, document.weights
    listed = range(len(names)) if transfers.anywhere else (place[n] for n in transfers.places)
    starts = {robot.name: place[robot.start] for robot in document.robots}
    return Problem(
        name=document.name,
        places=names,
        travel=_travel(document.travel, names),
        robots=tuple(
            Robot(
                robot.name,
                place[robot.start],
                None if robot.end is None else place[robot.end],
                robot.capacity,
                _window(robot.shift_s),
                _or_never(robot.max_duration_s),
                robot.speed,
            )
            for robot in document.robots
        ),
        items=tuple(_item(item, place, robots, starts) for item in document.items),
        transfers=Transfers(tuple(dict.fromkeys(listed)), transfers.together, transfers.service_s),
        weights=Weights(
            weights.distance,
            weights.makespan,
            weights.completion,
            weights.lateness,
            weights.robots,
        ),
        coordinates=_coordinates(document.travel, names),
    )


def _item(
    item: ItemEntry, place: dict[str, int], robots: dict[str, int], starts: dict[str, int]
) -> Item:
    aboard = None if item.aboard is None else robots[item.aboard]
    pickup = Visit(starts[item.aboard]) if item.aboard is not None else None
    if item.pickup is not None:
        pickup = _visit(item.pickup, place)
    assert pickup is not None, "an item has a pickup or is aboard"
    delivery = _visit(item.delivery, place)
    return Item(item.name, item.load, pickup, delivery, _or_never(item.max_on_board_s), aboard)


def _visit(visit: VisitEntry, place: dict[str, int]) -> Visit:
    window = _window(visit.window_s)
    return Visit(place[visit.place], window, _or_never(visit.due_s), visit.service_s)


def _window(span: Span) -> Window:
    return Window(span[0], _or_never(span[1]))


def _or_never(seconds: float | None) -> float:
    return inf if seconds is None else seconds


def _places_needed(document: DeliveryDocument) -> tuple[str, ...]:
    """The places where something can happen: of a building only those, unless it is anywhere."""
    names = place_names(document.travel)
    if document.transfers.anywhere or document.travel.graph is None:
        return names
    needed = set(document.transfers.places)
    for robot in document.robots:
        needed |= {robot.start, robot.end or robot.start}
    for item in document.items:
        needed |= {visit.place for visit in (item.pickup, item.delivery) if visit is not None}
    return tuple(name for name in names if name in needed)


def _travel(travel: TravelEntry, names: Sequence[str]) -> Travel:
    if travel.graph is not None:
        return travel_in(navigation_graph(travel.graph), travel.graph.speed_m_s, names)
    if travel.coordinates is not None:
        points = list(travel.coordinates.places.values())
        return Travel.euclidean(points, travel.coordinates.speed_m_s)
    assert travel.matrix is not None, "travel has one form"
    return _travel_of_matrix(travel.matrix)


def _travel_of_matrix(matrix: MatrixEntry) -> Travel:
    time_s = _numbers(matrix.time_s)
    return Travel(time_s if matrix.distance_m is None else _numbers(matrix.distance_m), time_s)


def _numbers(rows: Sequence[Sequence[float | None]]) -> Matrix:
    return np.array([[_or_never(each) for each in row] for row in rows], dtype=np.float64)


def navigation_graph(graph: GraphEntry) -> NavigationGraph:
    """The building of a document. Raises `NavigationError`."""
    return NavigationGraph(
        [Place(name, each.x, each.y, each.floor) for name, each in graph.places.items()],
        [
            Way(
                way.between[0],
                way.between[1],
                way.kind,
                way.length_m,
                way.delay_s,
                tuple((from_s, _or_never(until_s)) for from_s, until_s in way.open_s),
                way.closed,
                way.one_way,
                way.speed_m_s,
            )
            for way in graph.ways
        ],
    )


def _coordinates(
    travel: TravelEntry, names: Sequence[str]
) -> tuple[tuple[float, float], ...] | None:
    """Where to draw the places: the floors of a building one beside the other."""
    if travel.coordinates is not None:
        return tuple(travel.coordinates.places.values())
    if travel.graph is None:
        return None
    places = travel.graph.places
    depths = [place.y for place in places.values()]
    step = (max(depths) - min(depths)) * (1 + FLOOR_GAP) or 10.0
    return tuple((places[name].x, places[name].y + step * places[name].floor) for name in names)
