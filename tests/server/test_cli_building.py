"""`mend building` imports, makes up, checks and draws buildings."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from mend.fleet.request_file import read_request_file
from mend.server.cli import building
from mend.server.cli.building import app
from mend.server.cli.failures import CommandLineError
from mend.tasks import scene

EXAMPLE = Path(__file__).parents[2] / "examples" / "buildings" / "office.yaml"
NODES = [{"id": each, "loc": {"x": 5.0 * each, "y": 0.0}} for each in range(3)]
EDGES = [{"s0_id": 0, "s1_id": 1}, {"s0_id": 1, "s1_id": 2}]
PLAN = """
name: shop
levels:
  L1:
    vertices: [[0, 0, 0, till], [100, 0, 0, store]]
    lanes: [[0, 1, {bidirectional: [4, true]}]]
    measurements: [[0, 1, {distance: [3, 10.0]}]]
"""


def run(*arguments: object) -> str:
    result = CliRunner().invoke(app, [str(each) for each in arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


def test_as_many_robots_are_put_into_a_building_as_a_scene_takes() -> None:
    assert building.MOST_ROBOTS == scene.MOST_ROBOTS


def test_the_example_has_no_mistakes_and_a_picture_of_each_floor(tmp_path: Path) -> None:
    assert "3 floors, 66 places" in run("check", EXAMPLE)
    run("draw", EXAMPLE, "-o", tmp_path / "pictures")
    drawn = sorted(each.name for each in (tmp_path / "pictures").iterdir())
    assert drawn == ["F1.svg", "F2.svg", "F3.svg"]


def test_each_file_is_checked_also_after_a_wrong_one(tmp_path: Path) -> None:
    wrong = [tmp_path / name for name in ("one.yaml", "two.yaml")]
    for each in wrong:
        each.write_text("building: nowhere", encoding="utf-8")
    told = CliRunner().invoke(app, ["check", str(wrong[0]), str(EXAMPLE), str(wrong[1])])
    assert "3 floors, 66 places" in told.stdout
    assert isinstance(told.exception, CommandLineError)
    assert all(f"{each}" in str(told.exception) for each in wrong)


def test_what_is_made_up_has_no_mistakes(tmp_path: Path) -> None:
    path = tmp_path / "made" / "up.yaml"
    made = run("generate", "--seed", 2, "--floors", 3, "--rooms", 30, "-o", path)
    assert run("check", path) == made


def test_a_plan_of_open_rmf_is_imported(tmp_path: Path) -> None:
    plan, path = tmp_path / "shop.building.yaml", tmp_path / "shop.yaml"
    plan.write_text(PLAN, encoding="utf-8")
    assert "1 floor, 2 places, 1 lane, 0 doors" in run("import", plan, "-o", path)
    assert "2 places" in run("check", path)


def test_navigation_graphs_are_imported_with_an_elevator_between(tmp_path: Path) -> None:
    plans = [tmp_path / f"F{number}.navigation.json" for number in (1, 2)]
    for each in plans:
        each.write_text(json.dumps({"nodes": NODES, "edges": EDGES}), encoding="utf-8")
    path = tmp_path / "lab.yaml"
    assert "2 floors, 6 places" in run("import", *plans, "--elevator", "lift=F1:2,F2:0", "-o", path)


@pytest.mark.parametrize(
    ("content", "more", "told"),
    [
        ("levels: 3", [], "is no Open-RMF building.yaml: 'levels'"),
        ("levels: {L1: {}", [], "not valid YAML"),
        (PLAN.replace("[3, 10.0]", "[3, 0.0]"), [], "nothing on level 'L1' is measured"),
        (PLAN, ["--elevator", "lift=F1:2"], "names its lifts itself"),
    ],
)
def test_what_is_no_plan_is_refused_with_a_sentence(
    tmp_path: Path, content: str, more: list[str], told: str
) -> None:
    plan, path = tmp_path / "shop.building.yaml", tmp_path / "shop.yaml"
    plan.write_text(content, encoding="utf-8")
    path.write_text("what was there before", encoding="utf-8")
    with pytest.raises(CommandLineError, match=told):
        run("import", plan, "-o", path, *more)
    assert path.read_text(encoding="utf-8") == "what was there before"


def test_an_elevator_that_is_told_wrongly_is_refused(tmp_path: Path) -> None:
    plan = tmp_path / "F1.navigation.json"
    plan.write_text(json.dumps({"nodes": NODES, "edges": EDGES}), encoding="utf-8")
    for given, told in (
        (["lift"], "say NAME=FLOOR:NODE"),
        (["lift=F1:1"], "'lift=F1:1' is no elevator: give it a name, and a node on two floors"),
        (["lift=F1:1,F1:2"], "a node on two floors"),
        (["=F1:1,F2:2"], "give it a name"),
        (["lift=F1:1,F2:2", "lift=F1:0,F2:0"], "--elevator 'lift' is given twice"),
    ):
        options = [part for each in given for part in ("--elevator", each)]
        with pytest.raises(CommandLineError, match=told):
            run("import", plan, "-o", tmp_path / "x.yaml", *options)


def test_a_shift_is_drawn_for_a_scene_and_says_what_cannot_happen_there(tmp_path: Path) -> None:
    plan, scene = tmp_path / "shop.building.yaml", tmp_path / "scenes" / "shop.yaml"
    plan.write_text(PLAN, encoding="utf-8")
    run("import", plan, "-o", tmp_path / "shop.yaml")
    run("scene", tmp_path / "shop.yaml", "-o", scene)
    path = tmp_path / "shift.yaml"
    told = run("shift", scene, "--seed", 4, "-o", path)
    assert "no wrong floor: no elevator is on the way between any two rooms" in told
    assert "one robot alone" in told
    document = read_request_file(path)
    assert len(document.requests) == 8
    assert {each for request in document.requests for each in request.places} <= {
        "L1/till", "L1/store"
    }  # fmt: skip
    assert [each.kind for each in document.happenings] == ["nobody_answers", "cancelled"]
