"""Deliveries in a building that has a file of its own."""

from collections.abc import Mapping
from functools import partial
from math import inf
from pathlib import Path
from typing import Any

from mend.errors import NotFoundError, WrongInputError
from mend.fleet.scheduling.delivery_document import (
    DeliveryDocument,
    GraphEntry,
    PlaceEntry,
    TravelEntry,
    WayEntry,
)
from mend.fleet.scheduling.delivery_references import Mistake, places_named
from mend.maps.building.building import Building
from mend.maps.building.building_file import read_building_file
from mend.maps.navigation import NavigationGraph


def find_building(file: str, folder: Path | None) -> Building:
    """Read the building that a delivery file names.

    Raises `WrongInputError` with a sentence a line; also where only text was given, so that there
    is no folder to look in.
    """
    if folder is None:
        raise WrongInputError("a building's file can be named in a file alone: give its 'graph'")
    path = (folder / file).resolve()
    if not path.is_relative_to(folder.resolve()):
        raise WrongInputError(f"'{file}' must be below the folder of the delivery file")
    return read_building_file(path)


def in_building(
    document: DeliveryDocument, building: Building
) -> tuple[DeliveryDocument, list[Mistake]]:
    """The document with the building's graph, all places by their full names."""
    entry = document.travel.building
    assert entry is not None, "the document names a building"
    mistakes: list[Mistake] = []
    names: dict[str, str] = {}
    for location, name in places_named(document):
        try:
            names[name] = building.find(name)
        except NotFoundError as error:
            mistakes.append((location, str(error)))
            names[name] = next(iter(building.graph.places)).name
    travel = TravelEntry(graph=_graph_entry(building.graph, entry.speed_m_s))
    named = _renamed(document.model_dump(exclude={"travel"}), names)
    placed = DeliveryDocument.model_validate({**named, "travel": travel}, strict=False)
    return placed, mistakes


def _graph_entry(graph: NavigationGraph, speed_m_s: float) -> GraphEntry:
    return GraphEntry(
        speed_m_s=speed_m_s,
        places={
            each.name: PlaceEntry(x=each.x_m, y=each.y_m, floor=each.floor) for each in graph.places
        },
        ways=tuple(
            WayEntry(
                between=(each.a, each.b),
                kind=each.kind,
                length_m=each.length_m,
                delay_s=each.delay_s,
                open_s=tuple((a, None if b == inf else b) for a, b in each.open_s),
                closed=each.closed,
                one_way=each.one_way,
                speed_m_s=each.speed_m_s,
            )
            for each in graph.ways
        ),
    )


def _renamed(part: dict[str, Any], names: Mapping[str, str]) -> dict[str, Any]:
    """A document's dump with every place by its full name."""

    def visit(each: dict[str, Any] | None) -> dict[str, Any] | None:
        return None if each is None else {**each, "place": names[each["place"]]}

    named = partial(_named, names=names)
    robots = [
        {**each, "start": named(each["start"]), "end": named(each["end"])}
        for each in part["robots"]
    ]
    items = [
        {**each, "pickup": visit(each["pickup"]), "delivery": visit(each["delivery"])}
        for each in part["items"]
    ]
    places = [names[each] for each in part["transfers"]["places"]]
    return {
        **part,
        "robots": robots,
        "items": items,
        "transfers": {**part["transfers"], "places": places},
    }


def _named(name: str | None, names: Mapping[str, str]) -> str | None:
    return None if name is None else names[name]
