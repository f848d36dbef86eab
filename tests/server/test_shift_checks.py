"""What cannot happen in a shift is refused before it begins, with its line or its option."""

from pathlib import Path

import pytest
from languages_of_console import untold

from mend.fleet.request_file import RequestFileError, read_requests
from mend.maps.building.building import Building
from mend.maps.building.random_building import random_building
from mend.server.cli.building import run
from mend.server.cli.failures import CommandLineError
from mend.server.cli.report_file import require_writable
from mend.server.cli.shift_checks import checked_helpers, refuse_impossible
from mend.sim.building.scene import scene_of

OFFICE = Building(random_building(7, 2, 6))
SCENE = scene_of(OFFICE, "office", 2)
FLOOR = OFFICE.floors["F1"]
A, B = (f"F1/{each}" for each in FLOOR.lanes[0].between)
ROOM, OTHER = (f"F1/{each}" for each in ("101", "102"))

FILES = ("clauses", "refusals")


def refuse(folder: Path, *lines: str, transfers: tuple[str, ...] = ()) -> None:
    path = folder / "shift.yaml"
    wanted = f"requests: [{{kind: go_to_room, name: v, place: {ROOM}}}]"
    path.write_text("\n".join([wanted, *lines]), encoding="utf-8")
    refuse_impossible(read_requests(path), SCENE, transfers)


def test_what_can_happen_is_not_refused(tmp_path: Path) -> None:
    (elevator,) = list(OFFICE.document.elevators)[:1]
    refuse(
        tmp_path,
        "happenings:",
        f"  - {{kind: way_barred, between: [{B}, {A}], at_s: 1}}",
        "  - {kind: robot_fails, robot: robot2, at_s: 1}",
        "  - {kind: robot_fails, at_s: 1}",
        f"  - {{kind: wrong_floor, elevator: {elevator}, at_s: 1}}",
        "  - {kind: nobody_answers, at_s: 1}",
        f"transfer_places: [{OTHER}]",
        transfers=(ROOM,),
    )


@pytest.mark.parametrize(
    ("happening", "told"),
    [
        ("kind: robot_fails, robot: r9", "robot': this scene has no robot 'r9'; it has 'robot1'"),
        ("kind: wrong_floor, elevator: l9", "elevator': this building has no elevator 'l9'; it"),
        (
            f"kind: way_barred, between: [{A}, F1/no]",
            "between': this building has no place 'F1/no'",
        ),
        (
            f"kind: way_barred, between: [{ROOM}, {OTHER}]",
            f"between '{ROOM}' and '{OTHER}'; beside",
        ),
    ],
)
def test_what_cannot_happen_is_told_with_its_line_and_what_is_there(
    tmp_path: Path, happening: str, told: str
) -> None:
    with pytest.raises(RequestFileError) as raised:
        refuse(
            tmp_path,
            "happenings:",
            "  - {kind: nobody_answers, at_s: 3}",
            f"  - {{{happening}, at_s: 3}}",
        )
    assert f"{tmp_path / 'shift.yaml'}:4: 'happenings.1." in str(raised.value)
    assert told in str(raised.value)
    assert untold([each.message for each in raised.value.problems], FILES) == []


def test_a_transfer_place_that_is_not_there_is_told_with_those_that_are(tmp_path: Path) -> None:
    for place in ("F1/no", "F1/w0_0"):
        with pytest.raises(
            RequestFileError, match=f"yaml:2: 'transfer_places.0': .*'{place}'"
        ) as no:
            refuse(tmp_path, f"transfer_places: [{place}]")
        assert untold([each.message for each in no.value.problems], FILES) == []
    with pytest.raises(CommandLineError, match=r"--transfer: .*'F1/no'; there is 'F1/101'"):
        refuse(tmp_path, transfers=("F1/no",))
    with pytest.raises(
        CommandLineError, match=r"--transfer: .*'F1/w0_0'.*; robots are sent to 'F1/101'"
    ):
        refuse(tmp_path, transfers=("F1/w0_0",))


@pytest.mark.parametrize(
    ("wanted", "told"),
    [
        ("{kind: go_to_room, name: v, place: F1/no}", "'requests.0.place': "),
        (f"{{kind: transport, name: v, what: tea, origin: {ROOM}, destination: F9/1}}",
         "'requests.0.destination': "),
        ("{kind: go_to_room, name: v, place: F1/w0_0}", "robots are not sent to 'F1/w0_0'"),
    ],
)  # fmt: skip
def test_a_place_of_a_request_that_is_not_there_is_told_with_its_line(
    tmp_path: Path, wanted: str, told: str
) -> None:
    path = tmp_path / "shift.yaml"
    path.write_text(f"requests:\n  - {wanted}\n", encoding="utf-8")
    with pytest.raises(RequestFileError) as refused:
        refuse_impossible(read_requests(path), SCENE, ())
    assert f"{path}:2: " in str(refused.value)
    assert told in str(refused.value)
    assert untold([each.message for each in refused.value.problems], FILES) == []


def test_helpers_have_names_and_each_its_own(tmp_path: Path) -> None:
    assert checked_helpers(["ann", "bob"]) == ["ann", "bob"]
    with pytest.raises(CommandLineError, match="has to be a name of 1 to 64 characters"):
        checked_helpers([""])
    with pytest.raises(CommandLineError, match="--helper 'ann' is given twice"):
        checked_helpers(["ann", "bob", "ann"])
    with pytest.raises(RequestFileError, match=r":2: the helper 'ann' is named twice"):
        refuse(tmp_path, "helpers: [ann, ann]")


@pytest.mark.parametrize(
    ("option", "told"),
    [
        ({"capacity": 0.0}, "--capacity must be greater than 0, but it is 0.0"),
        ({"speed": "-1"}, "--speed must be greater than 0 or 'max'"),
        ({"speed": "nan"}, "--speed must be a finite number or 'max'"),
        ({"seed": -1}, "--seed must be greater than or equal to 0"),
    ],
)
def test_options_that_cannot_be_are_told_by_their_names(
    tmp_path: Path, option: dict[str, float], told: str
) -> None:
    scene, wanted = tmp_path / "office.yaml", tmp_path / "shift.yaml"
    scene.write_text(SCENE.model_dump_json(exclude_defaults=True), encoding="utf-8")
    wanted.write_text(f"requests: [{{kind: go_to_room, name: v, place: {ROOM}}}]", "utf-8")
    options = {"speed": "max", "seed": 0, "capacity": 3.0, **option}
    with pytest.raises(CommandLineError, match=told):
        run(scene, wanted, journal=tmp_path / "journal.db", **options)  # type: ignore[arg-type]


def test_a_report_that_cannot_be_written_is_told_before_the_shift(tmp_path: Path) -> None:
    report = tmp_path / "reports" / "shift.html"
    require_writable(report)
    assert not report.exists()
    assert report.parent.is_dir()
    (tmp_path / "file").touch()
    for wrong in (tmp_path, tmp_path / "file" / "shift.html"):
        with pytest.raises(CommandLineError, match=f"--report '{wrong}' cannot be written"):
            require_writable(wrong)
