"""What a delivery file names that is not there, names twice, or says the wrong way round."""

from collections.abc import Iterator

from mend.documents.problem import list_names
from mend.fleet.scheduling.delivery_document import (
    DeliveryDocument,
    GraphEntry,
    MatrixEntry,
    Span,
    TravelEntry,
)
from mend.maps.navigation import WayKind

Location = tuple[str | int, ...]
Mistake = tuple[Location, str]
"""Where in the document, and a sentence."""


def place_names(travel: TravelEntry) -> tuple[str, ...]:
    """The names of all places, in the order of the file."""
    form = travel.graph or travel.coordinates or travel.matrix
    assert form is not None, "travel has one form"
    return tuple(form.places)


def find_mistakes(document: DeliveryDocument) -> Iterator[Mistake]:
    """Every mistake that only the whole document shows."""
    if document.travel.graph is not None:
        yield from _graph_mistakes(document.travel.graph)
    if document.travel.matrix is not None:
        yield from _matrix_mistakes(document.travel.matrix)
    robots = [robot.name for robot in document.robots]
    yield from _named_twice("robots", robots)
    yield from _named_twice("items", [item.name for item in document.items])
    known = frozenset(place_names(document.travel))
    for location, name in places_named(document):
        if name not in known:
            yield location, f"there is no place '{name}'; there are {list_names(known)}"
    for location, span in _spans(document):
        yield from _reversed(location, span)
    for number, item in enumerate(document.items):
        if item.aboard is not None and item.aboard not in robots:
            message = f"there is no robot '{item.aboard}'; there are {list_names(robots)}"
            yield ("items", number, "aboard"), message


def _named_twice(where: str, names: list[str]) -> Iterator[Mistake]:
    seen: set[str] = set()
    for number, name in enumerate(names):
        if name in seen:
            yield (where, number, "name"), f"the name '{name}' is given twice"
        seen.add(name)


def places_named(document: DeliveryDocument) -> Iterator[tuple[Location, str]]:
    """Every place that robots, items and transfers name, and where."""
    for number, robot in enumerate(document.robots):
        yield ("robots", number, "start"), robot.start
        if robot.end is not None:
            yield ("robots", number, "end"), robot.end
    for number, item in enumerate(document.items):
        if item.pickup is not None:
            yield ("items", number, "pickup", "place"), item.pickup.place
        yield ("items", number, "delivery", "place"), item.delivery.place
    for number, name in enumerate(document.transfers.places):
        yield ("transfers", "places", number), name


def _spans(document: DeliveryDocument) -> Iterator[tuple[Location, Span]]:
    for number, robot in enumerate(document.robots):
        yield ("robots", number, "shift_s"), robot.shift_s
    for number, item in enumerate(document.items):
        for what, visit in (("pickup", item.pickup), ("delivery", item.delivery)):
            if visit is not None:
                yield ("items", number, what, "window_s"), visit.window_s


def _reversed(location: Location, span: Span) -> Iterator[Mistake]:
    if span[1] is not None and span[0] > span[1]:
        where = ".".join(str(step) for step in location)
        yield location, f"'{where}' ends at {span[1]:g} s, before it begins at {span[0]:g} s"


def _graph_mistakes(graph: GraphEntry) -> Iterator[Mistake]:
    for number, way in enumerate(graph.ways):
        here: Location = ("travel", "graph", "ways", number)
        missing = [name for name in way.between if name not in graph.places]
        for name in missing:
            message = f"there is no place '{name}'; there are {list_names(graph.places)}"
            yield (*here, "between"), message
        for span in way.open_s:
            yield from _reversed((*here, "open_s"), span)
        if way.between[0] == way.between[1]:
            yield (*here, "between"), f"the way leads from '{way.between[0]}' to itself"
        elif not missing and way.kind is not WayKind.ELEVATOR:
            a, b = (graph.places[name].floor for name in way.between)
            if a != b:
                message = f"the way joins floors {a} and {b}, which only an 'elevator' does"
                yield (*here, "between"), message


def _matrix_mistakes(matrix: MatrixEntry) -> Iterator[Mistake]:
    yield from _named_twice_in_matrix(matrix)
    count = len(matrix.places)
    for key, rows in (("time_s", matrix.time_s), ("distance_m", matrix.distance_m)):
        if rows is None:
            continue
        here: Location = ("travel", "matrix", key)
        if len(rows) != count:
            yield here, f"'{key}' has {len(rows)} rows for {count} places"
        for number, row in enumerate(rows):
            if len(row) != count:
                yield (*here, number), f"the row has {len(row)} numbers for {count} places"
            elif number < count and row[number] != 0:
                yield (*here, number), f"from '{matrix.places[number]}' to itself must be 0"


def _named_twice_in_matrix(matrix: MatrixEntry) -> Iterator[Mistake]:
    for number, name in enumerate(matrix.places):
        if name in matrix.places[:number]:
            yield ("travel", "matrix", "places", number), f"the name '{name}' is given twice"
