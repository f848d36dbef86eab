"""`mend building`: import, make up, check and draw buildings, and have robots work there."""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mend.server.cli.failures import CommandLineError, told_plainly

if TYPE_CHECKING:
    from mend.maps.building.building import BuildingDocument
    from mend.maps.building.tidying import Imported

app = typer.Typer(
    name="building",
    help="Import, make up, check and draw buildings, and have robots work there.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

MOST_ROBOTS = 64
"""As scenes have it, which take long to load."""

OutputFile = Annotated[
    Path, typer.Option("--output", "-o", metavar="FILE", help="Where to write it, .yaml.")
]
BuildingFile = Annotated[Path, typer.Argument(metavar="FILE", help="A building file.")]


@app.command()
def run(
    scene: Annotated[
        Path, typer.Argument(metavar="SCENE", help="A scene of a building (mend building scene).")
    ],
    requests: Annotated[Path, typer.Argument(metavar="REQUESTS", help="A request file.")],
    seed: Annotated[int, typer.Option(help="Makes every chance in it repeatable.")] = 0,
    speed: Annotated[
        str, typer.Option(help="Simulated seconds per second, or max for as fast as possible.")
    ] = "max",
    option: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE",
            help="What the building has to choose (docs/buildings.md); may be given several times.",
        ),
    ] = None,
    capacity: Annotated[float, typer.Option(help="How many loads a basket takes.")] = 3.0,
    transfer: Annotated[
        list[str] | None,
        typer.Option(
            metavar="PLACE", help="Where things may change robots, instead of as the file says."
        ),
    ] = None,
    helper: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME", help="Whom robots ask, in this order, instead of as the file says."
        ),
    ] = None,
    journal: Annotated[Path | None, typer.Option(help="Where to keep its journal.")] = None,
    report: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write a report of it, .html.")
    ] = None,
) -> None:
    """Have robots meet the requests of a file, helped by somebody who does what they ask.

    Prints what happens; the exit code is 0 where everything was done that somebody still wanted.
    """
    import asyncio

    from mend.fleet.request_file import read_requests
    from mend.server.cli.journals import new_run_journal
    from mend.server.cli.report import write_report
    from mend.server.cli.report_file import require_writable
    from mend.server.cli.run_request import (
        checked_request,
        closed_settings,
        read_options,
        read_speed,
    )
    from mend.server.cli.shift import Shift
    from mend.server.cli.shift_checks import checked_helpers, refuse_impossible
    from mend.server.cli.task_files import read_scene
    from mend.server.sites.requests import FleetOptions

    with told_plainly():
        own = closed_settings()
        kept = journal or new_run_journal(own, "shift")
        read, setting = read_requests(requests), read_scene(scene)
        document = read.document
        refuse_impossible(read, setting, transfer or [])
        asked = checked_helpers(helper or document.helpers)
        settings = own.model_copy(update={"journal": kept, "helpers": asked})
        shift = Shift(
            setting,
            document,
            seed=seed,
            options=read_options(option or []),
            fleet=checked_request(
                FleetOptions,
                capacity=capacity,
                transfer_places=tuple(transfer or document.transfer_places),
                answers="yes",
            ),
            speed=read_speed(speed),
        )
        if report is not None:
            require_writable(report)
        code = asyncio.run(shift.carry_out(settings))
        if report is not None:
            write_report(kept, report)
            typer.echo(f"report: {report}")
    raise typer.Exit(code)


@app.command("import", short_help="Import a plan of Open-RMF, or CoBot navigation graphs.")
def import_(
    plans: Annotated[
        list[Path],
        typer.Argument(
            metavar="PLAN...",
            help="A building.yaml of Open-RMF; or navigation graphs (.json), the lowest floor "
            "first, each with NAME.vectormap.json beside it for the walls.",
        ),
    ],
    output: OutputFile,
    graph: Annotated[
        list[int] | None, typer.Option(help="Of an Open-RMF plan only these lanes' graphs.")
    ] = None,
    elevator: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=FLOOR:NODE,...", help="Where an elevator between CoBot floors stops."
        ),
    ] = None,
) -> None:
    """Write a building file from a plan, and say what of it could not be used.

    Lanes that lead through walls and places that are cut off from the rest are left out.
    """
    with told_plainly():
        cobot = all(each.suffix == ".json" for each in plans)
        if not cobot and (len(plans) > 1 or elevator):
            raise CommandLineError("an Open-RMF plan is one file, which names its lifts itself")
        imported = _from_cobot(plans, elevator or []) if cobot else _from_rmf(plans[0], graph or [])
        _write(imported.document, output)
    for note in imported.notes:
        typer.echo(note, err=True)
    typer.echo(f"{output}: {_summary(imported.document)}")


@app.command("generate", short_help="Make an office building up.")
def generate(
    output: OutputFile,
    seed: Annotated[int, typer.Option(min=0, help="Another building for each; always the same.")],
    floors: Annotated[int, typer.Option(min=1, max=30)] = 4,
    rooms: Annotated[int, typer.Option(min=1, max=80, help="On each floor.")] = 20,
) -> None:
    """Make an office building up: corridors with rooms, doors, chargers and elevators."""
    from mend.maps.building.random_building import random_building

    with told_plainly():
        document = random_building(seed, floors, rooms)
        _write(document, output)
    typer.echo(f"{output}: {_summary(document)}")


@app.command("check", short_help="Find the mistakes of a building file.")
def check(files: Annotated[list[Path], typer.Argument(metavar="FILE...")]) -> None:
    """Say for each file what is wrong with it, or how large the building is."""
    from mend.maps.building.building_file import read_building_file

    wrong = []
    for each in files:
        try:
            with told_plainly():
                building = read_building_file(each)
        except CommandLineError as error:
            wrong.append(str(error))
        else:
            typer.echo(f"{each}: {_summary(building.document)}")
    if wrong:
        raise CommandLineError("\n".join(wrong))


@app.command("draw", short_help="Draw every floor.")
def draw(
    file: BuildingFile,
    folder: Annotated[
        Path, typer.Option("--output", "-o", metavar="FOLDER", help="Where to write the pictures.")
    ],
) -> None:
    """Draw every floor as an SVG of its own, named after the floor."""
    from mend.maps.building.building_file import read_building_file
    from mend.maps.building.drawing import floor_picture

    with told_plainly():
        building = read_building_file(file)
        folder.mkdir(parents=True, exist_ok=True)
        for name in building.floors:
            path = folder / f"{name}.svg"
            path.write_text(floor_picture(building, name), encoding="utf-8")
            typer.echo(path)


@app.command("scene", short_help="Make a scene of a building, with robots in it.")
def scene(
    file: BuildingFile,
    output: OutputFile,
    robots: Annotated[
        int, typer.Option(min=1, max=MOST_ROBOTS, help="How many robots are in it.")
    ] = 1,
) -> None:
    """Write a scene file that task files can name: the building, its places, and robots in it.

    Robots begin one on each floor first, at a charger or where they park if there is one.
    """
    from mend.documents.problem import list_names
    from mend.documents.spellings import NAME, SPELLINGS
    from mend.maps.building.building_file import document_text, read_building_file
    from mend.sim.building.scene import scene_of

    with told_plainly():
        name = output.stem
        if not re.fullmatch(NAME, name):
            raise CommandLineError(f"a scene is called after its file: '{name}' {SPELLINGS[NAME]}")
        made = scene_of(read_building_file(file), name, robots)
        output.parent.mkdir(parents=True, exist_ok=True)
        text = document_text(made.model_dump(mode="json", exclude_defaults=True))
        output.write_text(text, encoding="utf-8")
    typer.echo(f"{output}: {list_names(made.robots)} among {len(made.places)} places")


@app.command("shift", short_help="Draw requests and happenings for a scene.")
def shift(
    scene: Annotated[
        Path, typer.Argument(metavar="SCENE", help="A scene of a building (mend building scene).")
    ],
    output: OutputFile,
    seed: Annotated[int, typer.Option(min=0, help="Another shift for each; always the same.")],
    hours: Annotated[float, typer.Option(min=0.5, max=24.0, help="How long it lasts.")] = 2.0,
) -> None:
    """Draw what people ask, and what happens meanwhile, as a request file for `building run`.

    Said is what cannot happen in this building, as where no elevator is.
    """
    from mend.fleet.shifts.drawn_shift import drawn_shift
    from mend.maps.building.building_file import document_text
    from mend.server.cli.task_files import read_scene
    from mend.server.fleets.place_names import PlaceNames
    from mend.sim.building.setting import building_of

    with told_plainly():
        read = read_scene(scene)
        building = building_of(read)
        places = PlaceNames(building, read)
        starts = {
            name: start
            for name, base in read.robots.items()
            if (start := places.nearest(base.x, base.y, base.z)) is not None
        }
        drawn = drawn_shift(building, starts, places.names, seed, hours * 3600.0)
        output.parent.mkdir(parents=True, exist_ok=True)
        text = document_text(drawn.document.model_dump(mode="json", exclude_none=True))
        output.write_text(text, encoding="utf-8")
    for note in drawn.notes:
        typer.echo(note, err=True)
    happen = len(drawn.document.happenings)
    typer.echo(f"{output}: {len(drawn.document.requests)} requests, {happen} happenings")


def _from_rmf(plan: Path, graphs: list[int]) -> "Imported":
    from pydantic import ValidationError

    from mend.maps.building.open_rmf import import_open_rmf

    try:
        return import_open_rmf(_read(plan), graphs)
    except ValidationError as error:
        raise CommandLineError(_no_plan(plan, "Open-RMF building.yaml", error)) from error


def _from_cobot(plans: list[Path], elevators: list[str]) -> "Imported":
    from pydantic import ValidationError

    from mend.maps.building.cobot import CobotFloor, import_cobot
    from mend.maps.vector_map_file import read_vector_map

    floors = {}
    for each in plans:
        name = each.name.split(".")[0]
        walls = each.with_name(f"{name}.vectormap.json")
        floors[name] = CobotFloor(_read(each), read_vector_map(walls) if walls.exists() else None)
    cabins: dict[str, dict[str, int]] = {}
    for name, stops in map(_cabin, elevators):
        if name in cabins:
            raise CommandLineError(f"--elevator '{name}' is given twice: say all its stops at once")
        cabins[name] = stops
    try:
        return import_cobot(plans[0].name.split(".")[0], floors, cabins)
    except ValidationError as error:
        raise CommandLineError(_no_plan(plans[0], "navigation graph", error)) from error


def _cabin(text: str) -> tuple[str, dict[str, int]]:
    name, _, stops = text.partition("=")
    try:
        told = [each.rsplit(":", 1) for each in stops.split(",")]
        at = {floor: int(node) for floor, node in told}
    except ValueError:
        raise CommandLineError(
            f"'{text}' is no elevator: say NAME=FLOOR:NODE,FLOOR:NODE, as lift=F1:8,F2:6"
        ) from None
    if name == "" or len(at) < max(2, len(told)):
        raise CommandLineError(f"'{text}' is no elevator: give it a name, and a node on two floors")
    return name, at


def _read(path: Path) -> Any:
    from mend.documents.document import DocumentError, read_document, read_text

    try:
        return read_document(read_text(path))[0]
    except DocumentError as error:
        raise CommandLineError(error.problem.describe(str(path))) from error


def _no_plan(path: Path, expected: str, error: Any) -> str:
    first = error.errors(include_url=False)[0]
    where = ".".join(str(each) for each in first["loc"])
    return f"{path} is no {expected}: '{where}': {first['msg'].lower()}"


def _write(document: "BuildingDocument", path: Path) -> None:
    """Raises `CommandLineError` where robots could not drive through it."""
    from mend.maps.building.building_file import building_text, check_building

    if mistakes := check_building(document):
        raise CommandLineError("\n".join(message for _, message in mistakes))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(building_text(document), encoding="utf-8")


def _summary(document: "BuildingDocument") -> str:
    floors = document.floors.values()
    counts = [
        (len(document.floors), "floor"),
        (sum(len(each.places) for each in floors), "place"),
        (sum(len(each.lanes) for each in floors), "lane"),
        (sum(len(each.doors) for each in floors), "door"),
        (len(document.elevators), "elevator"),
    ]
    return ", ".join(f"{n} {what}{'' if n == 1 else 's'}" for n, what in counts)
