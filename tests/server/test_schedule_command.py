"""`mend schedule`: what it prints, what it draws, and with which exit code."""

import json
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest

from mend.server.cli import main
from mend.server.cli.check import kind_of_file

EXAMPLES = Path(__file__).parents[2] / "examples/deliveries"
CORRIDOR = str(EXAMPLES / "corridor.yaml")
LI_LIM = """\
2\t10\t1
0\t0\t0\t0\t0\t100\t0\t0\t0
1\t3\t4\t5\t0\t50\t9\t0\t2
2\t6\t8\t-5\t10\t90\t9\t1\t0
"""
TRANSFER = """\
nr nv nt capacity
1 1 1 7

node x y a b load
p0 0 0 0 10 3
d0 3 4 5 20 -3
o0 0 0 0 30 0
e0 6 8 0 30 0
t0 1 1 0 30 0
"""


@pytest.fixture
def mend(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Any:
    def call(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["mend", *(str(each) for each in arguments)])
        code = 0
        try:
            main()
        except SystemExit as error:
            code = int(error.code or 0)
        out, err = capsys.readouterr()
        return code, out, err

    return call


def write(folder: Path, text: str, name: str = "instance.txt") -> Path:
    path = folder / name
    path.write_text(text)
    return path


CLASH = """\
name: clash
travel: {coordinates: {places: {a: [0, 0], b: [40, 0]}}}
robots: [{name: ada, start: a, capacity: 1}]
items:
- {name: post, load: 1, pickup: {place: a}, delivery: {place: b, window_s: [0, 50]}}
- {name: tea, load: 1, pickup: {place: a}, delivery: {place: b, window_s: [0, 50]}}
"""


def test_items_that_clash_are_named_with_what_does_not_hold_together(
    mend: Any, tmp_path: Path
) -> None:
    file = write(tmp_path, CLASH, "clash.yaml")
    code, out, err = mend("schedule", file, "--seconds", "5")
    assert (code, out) == (1, "")
    assert "items 'post' and 'tea' cannot all be delivered" in err
    assert "ada carries no more than 1" in err


def test_an_item_that_was_left_over_is_named_where_nothing_is_proved(
    mend: Any, tmp_path: Path
) -> None:
    file = write(tmp_path, CLASH, "clash.yaml")
    code, out, err = mend("schedule", file, "--seconds", "5", "--method", "greedy")
    assert (code, out) == (1, "")
    assert "unknown" in err
    assert "item 'tea' has no place in time beside what the robots have to do already" in err
    assert "to drop tea at b must begin by 50 s" in err


def test_getting_ready_is_announced(mend: Any, tmp_path: Path) -> None:
    file = write(tmp_path, LI_LIM)
    code, _, err = mend("schedule", file, "--method", "alns", "--seconds", "0.2")
    assert code == 0
    assert err.startswith("getting the search ready")


def test_table_has_a_row_for_every_stop(mend: Any) -> None:
    code, out, err = mend("schedule", CORRIDOR, "--seconds", "5")
    assert code == 0
    head, *rows = out.splitlines()
    assert head.startswith("optimal, objective 122.31, bound 122.31, 2 robots")
    assert next(row.split("\t")[-1] for row in rows if row.startswith("ada")) == "starts"
    assert any("gives letters to ben" in row for row in rows)
    assert any("takes letters from ada" in row for row in rows)
    assert "best 122.31" in err


def test_json_has_the_result_and_nothing_else(mend: Any) -> None:
    code, out, _ = mend("schedule", CORRIDOR, "--json", "--method", "insertion")
    result = json.loads(out)
    assert code == 0
    assert list(result) == [
        "status", "objective", "bound", "vehicles", "distance", "transfers", "seconds", "routes",
    ]  # fmt: skip
    assert (result["status"], result["bound"], result["vehicles"]) == ("feasible", None, 2)
    assert sum(route["distance"] for route in result["routes"]) == pytest.approx(result["distance"])
    gives = [stop for route in result["routes"] for stop in route["stops"] if stop["partner"]]
    assert len(gives) == 2 * result["transfers"]


def test_objective_of_li_and_lim_is_the_distance(mend: Any, tmp_path: Path) -> None:
    path = write(tmp_path, LI_LIM)
    for method in ("exact", "greedy"):
        code, out, err = mend("schedule", path, "--json", "--method", method, "--seconds", "5")
        result = json.loads(out)
        assert code == 0
        assert (result["vehicles"], result["distance"]) == (1, 20.0)
        assert result["objective"] == result["distance"]
        assert "best 1 robots, 20.00 m" in err
        if method == "exact":
            assert (result["status"], result["bound"]) == ("optimal", 20.0)


def test_formats_are_told_apart(mend: Any, tmp_path: Path) -> None:
    yaml = write(tmp_path, Path(CORRIDOR).read_text(), "deliveries")
    for path in (write(tmp_path, TRANSFER), yaml):
        assert mend("schedule", path, "--method", "insertion")[0] == 0
    assert mend("schedule", write(tmp_path, TRANSFER), "--format", "li_lim")[0] == 2


def test_without_transfers_the_corridor_has_no_schedule(mend: Any) -> None:
    code, out, err = mend("schedule", CORRIDOR, "--no-transfers", "--json")
    result = json.loads(out)
    assert (code, result["status"], result["routes"]) == (1, "infeasible", None)
    assert "item 'letters' cannot be delivered even if a robot does nothing else" in err
    assert "may be away for 90 s" in err


@pytest.mark.parametrize("example", sorted(EXAMPLES.glob("*.yaml")), ids=lambda path: path.stem)
def test_picture_is_svg_with_every_item_and_no_name_over_another(
    mend: Any, tmp_path: Path, example: Path
) -> None:
    picture = tmp_path / "out" / "plan.svg"
    assert mend("schedule", example, "--method", "insertion", "--plot", picture)[0] == 0
    root = ET.fromstring(picture.read_text())
    texts = [each for each in root.iter() if each.tag.endswith("}text")]
    names = [each.text for each in texts]
    for line in example.read_text().splitlines():
        if line.lstrip().startswith("- name: ") and "robot" not in line:
            assert line.split("- name: ")[1] in names
    boxes = [_box(each) for each in texts if "halo" in each.get("class", "")]
    for number, a in enumerate(boxes):
        for b in boxes[:number]:
            assert not (a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3])
    assert "prefers-color-scheme: dark" in picture.read_text()
    assert "http" not in picture.read_text().replace("http://www.w3.org/2000/svg", "")


def _box(text: ET.Element) -> tuple[float, float, float, float]:
    x, y, width = float(text.get("x", 0)), float(text.get("y", 0)), 6.8 * len(text.text or "")
    return x, y - 9, x + width, y + 1


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("nowhere.yaml",), "'nowhere.yaml': No such file or directory"),
        ((CORRIDOR, "--method", "magic"), "there is no method 'magic'; there are auto, "),
        ((CORRIDOR, "--format", "magic"), "there is no format 'magic'; there are auto, problem"),
        ((CORRIDOR, "--plot", "plan.png"), "the picture's file has to end in .svg"),
        ((EXAMPLES / "office_hours.yaml", "--method", "exact"), "doors that open and close"),
    ],
)
def test_wrong_requests_get_one_sentence(
    mend: Any, arguments: tuple[object, ...], sentence: str
) -> None:
    code, out, err = mend("schedule", *arguments)
    assert (code, out) == (2, "")
    assert err.startswith("mend: ")
    assert sentence in err
    assert len(err.splitlines()) == 1


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "is neither a delivery file nor an instance"),
        ("hello\n", "is neither a delivery file nor an instance"),
        (LI_LIM.replace("-5", "-4"), "line 3: the loads of 1 and 2 do not match"),
        ("name: x\ntravel: 5\n", "'travel'"),
    ],
)
def test_wrong_files_get_sentences(mend: Any, tmp_path: Path, text: str, sentence: str) -> None:
    path = write(tmp_path, text)
    code, _, err = mend("schedule", path)
    assert code == 2
    assert str(path) in err
    assert sentence in err


def test_check_knows_delivery_files(mend: Any, tmp_path: Path) -> None:
    text = Path(CORRIDOR).read_text()
    assert kind_of_file(text) == "delivery"
    assert mend("check", CORRIDOR)[0] == 0
    wrong = write(tmp_path, text.replace("start: west", "start: moon"), "wrong.yaml")
    code, _, err = mend("check", wrong)
    assert code == 1
    assert "there is no place 'moon'" in err
    heavy = write(tmp_path, text.replace("load: 2", "load: 9"), "heavy.yaml")
    code, _, err = mend("check", heavy)
    assert code == 1
    assert "item 'parcel' has a load of 9, but no robot carries more than 3" in err


def test_schema_of_delivery_files_is_json(mend: Any) -> None:
    code, out, _ = mend("schema", "delivery")
    assert code == 0
    assert json.loads(out)["title"] == "DeliveryDocument"


@pytest.mark.slow
def test_what_serves_and_checks_delivery_files_does_without_or_tools() -> None:
    program = (
        "import sys; sys.modules['ortools'] = None; import mend.server.composition; "
        "from mend.server.cli import main; sys.argv = ['mend', 'check', sys.argv[1]]; main()"
    )
    subprocess.run([sys.executable, "-c", program, CORRIDOR], check=True, capture_output=True)
