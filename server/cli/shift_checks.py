"""What a shift cannot be with: told before it begins, with the line or the option."""

from collections.abc import Iterator, Sequence

from pydantic import TypeAdapter, ValidationError

from mend.documents.problem import list_names
from mend.errors import NotFoundError, WrongInputError
from mend.fleet.happenings import Happening, RobotFails, WayBarred, WrongFloor
from mend.fleet.request_file import Place, ReadRequests, RequestsDocument
from mend.maps.building.building import Building
from mend.server.cli.failures import CommandLineError
from mend.server.dialogues.escalation import HelperName
from mend.server.fleets.place_names import PlaceNames
from mend.sim.building.setting import read_setting
from mend.tasks.frames import frames_of
from mend.tasks.scene import Scene

_HELPER: TypeAdapter[str] = TypeAdapter(HelperName)


def refuse_impossible(read: ReadRequests, scene: Scene, transfers: Sequence[str]) -> None:
    """Raises `RequestFileError` for what cannot happen in this scene, and `CommandLineError` for
    `transfers`, places of the command line, to which no robot is sent.

    A scene without a building is refused by who opens its world.
    """
    building = read_setting(scene)[1]
    if building is None:
        return
    read.refuse(_mistakes(read.document, scene, building))
    places = PlaceNames(building, scene)
    for each in transfers:
        if (told := _no_goal(places, each)) is not None:
            raise CommandLineError(f"--transfer: {told}")


def checked_helpers(given: Sequence[str]) -> list[str]:
    """The helpers of the command line. Raises `CommandLineError` for what is no name, or twice."""
    for number, each in enumerate(given):
        try:
            _HELPER.validate_python(each)
        except ValidationError:
            raise CommandLineError(
                f"--helper is '{each[:80]}'; it has to be a name of 1 to 64 characters"
            ) from None
        if each in given[:number]:
            raise CommandLineError(f"--helper '{each}' is given twice")
    return list(given)


def _mistakes(
    document: RequestsDocument, scene: Scene, building: Building
) -> Iterator[tuple[Place, str]]:
    for number, each in enumerate(document.happenings):
        for field, told in _impossible(each, scene, building):
            yield ("happenings", number, field), f"'happenings.{number}.{field}': {told}"
    places = PlaceNames(building, scene)
    for number, request in enumerate(document.requests):
        for field in ("place", "origin", "destination"):
            name = getattr(request, field, None)
            if name is not None and (why := _no_goal(places, name)) is not None:
                yield ("requests", number, field), f"'requests.{number}.{field}': {why}"
    for number, name in enumerate(document.transfer_places):
        if (why := _no_goal(places, name)) is not None:
            yield ("transfer_places", number), f"'transfer_places.{number}': {why}"


def _impossible(
    happening: Happening, scene: Scene, building: Building
) -> Iterator[tuple[str, str]]:
    """Which field of it is wrong, and why."""
    match happening:
        case RobotFails(robot=str(robot)) if robot not in (known := frames_of(scene)):
            yield "robot", f"this scene has no robot '{robot}'; it has {list_names(known)}"
        case WrongFloor(elevator=elevator) if elevator not in building.document.elevators:
            known_ones = list_names(building.document.elevators)
            there = f"it has {known_ones}" if known_ones else "it has none"
            yield "elevator", f"this building has no elevator '{elevator}'; {there}"
        case WayBarred(between=between) if (told := _no_lane(building, *between)) is not None:
            yield "between", told


def _no_lane(building: Building, a: str, b: str) -> str | None:
    """Why nothing can bar the way between two places; None where it can."""
    lanes = [
        {f"{floor}/{end}" for end in lane.between}
        for floor, each in building.floors.items()
        for lane in each.lanes
    ]
    if {a, b} in lanes:
        return None
    known = [f"{floor}/{name}" for floor, each in building.floors.items() for name in each.places]
    for each in (a, b):
        if each not in known:
            return f"this building has no place '{each}'; say two neighbours, each as FLOOR/PLACE"
    beside = list_names(end for lane in lanes if a in lane for end in lane - {a})
    return f"no lane leads between '{a}' and '{b}'; beside '{a}' are {beside}"


def _no_goal(places: PlaceNames, name: str) -> str | None:
    """Why no robot is sent to a place; None where one is."""
    try:
        places.in_scene(name)
    except NotFoundError as error:
        return str(error)
    except WrongInputError as error:
        return f"{error}; robots are sent to {list_names(places.names)}"
    return None
