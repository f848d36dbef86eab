"""`mend building run`: robots meet the requests of a file, and each line of it is so."""

from pathlib import Path

import pytest
import yaml
from forked_mend import mend_command
from sampled import sample

from mend.maps.building.building import (
    Building,
    BuildingDocument,
    Floor,
    FloorPlace,
    Lane,
    PlaceKind,
)
from mend.sim.building.scene import scene_of
from mend.tasks.scene import Base

EXAMPLES = Path(__file__).parents[2] / "examples" / "buildings"
SCENE, REQUESTS = EXAMPLES / "scenes" / "office_at_work.yaml", EXAMPLES / "requests.yaml"
ALL_NAMES = ("mail", "keys", "lunch", "guest", "visit")
NAMES = sample(("mail",), ALL_NAMES)


async def run(folder: Path, *arguments: str) -> tuple[int, str, str]:
    command = mend_command("building", "run", *arguments, XDG_DATA_HOME=str(folder))
    async with command as running:
        return await running.outcome()


@pytest.mark.slow(4)
async def test_the_shipped_requests_are_met(tmp_path: Path) -> None:
    shipped = yaml.safe_load(REQUESTS.read_text("utf-8"))["requests"]
    assert tuple(each["name"] for each in shipped) == ALL_NAMES
    wanted = tmp_path / "requests.yaml"
    wanted.write_text(yaml.safe_dump({"requests": [e for e in shipped if e["name"] in NAMES]}))
    exact = ("--option", "localizer=exact", "--option", "unmapped=0")
    code, told, complaints = await run(tmp_path, str(SCENE), str(wanted), *exact)
    assert code == 0, complaints
    lines = [line[10:] for line in told.splitlines()]
    assert lines[-1] == f"of {len(NAMES)} requests: {len(NAMES)} done"
    assert "shutting down" not in complaints
    for name in NAMES:
        assert any(line.startswith(f"'{name}' is done") for line in lines)
    times = [float(line[:8]) for line in told.splitlines()]
    assert times == sorted(times)


async def test_what_cannot_be_met_is_refused_with_when_it_could_be(tmp_path: Path) -> None:
    hasty = tmp_path / "requests.yaml"
    hasty.write_text(
        "requests: [{kind: go_to_room, name: r, place: F3/305, latest_s: 2}]\n"
        "happenings: [{kind: robot_fails, at_s: 900}]\n"
    )
    code, told, complaints = await run(tmp_path, str(SCENE), str(hasty))
    assert code == 1, complaints
    assert "refused: 'r' cannot be met" in told
    assert "it would be possible" in told
    late = "'happenings.0' (robot_fails, at 900 s) did not come: everything was over before"
    assert late in told
    assert told.splitlines()[-1].endswith("of 1 requests: 1 refused")


async def test_a_shift_is_summed_up_and_reported_though_a_robot_still_charges(
    tmp_path: Path,
) -> None:
    corridor = Floor(
        places={
            "charger": FloorPlace(x=0.0, y=0.0, kind=PlaceKind.CHARGER),
            "1": FloorPlace(x=60.0, y=0.0, kind=PlaceKind.ROOM),
            "2": FloorPlace(x=64.0, y=0.0, kind=PlaceKind.ROOM),
        },
        lanes=(Lane(between=("charger", "1")), Lane(between=("1", "2"))),
        walls=((-2.0, -1.5, 66.0, -1.5), (-2.0, 1.5, 66.0, 1.5)),
    )
    made = scene_of(Building(BuildingDocument(building="b", floors={"F1": corridor})), "s", 2)
    away = {f"robot{n}": Base(x=56.0 + 4.0 * n, y=0.0) for n in (1, 2)}
    scene, wanted, report = (tmp_path / each for each in ("s.yaml", "wanted.yaml", "report.html"))
    scene.write_text(
        made.model_copy(update={"robots": away}).model_dump_json(exclude_defaults=True)
    )
    # Meanwhile the other one has less than it is to hold, and a long way to the charger.
    tell = "{kind: deliver_message, name: tell, place: '1', message: Tea, earliest_s: 125}"
    fails = "{kind: robot_fails, at_s: 5}"
    wanted.write_text(f"requests: [{tell}]\nhappenings: [{fails}]\n")
    little = ("--option", "localizer=exact", "--option", "battery_wh=3")
    arguments = (str(scene), str(wanted), *little, "--report", str(report))
    code, told, complaints = await run(tmp_path, *arguments)
    assert code == 0, complaints
    assert " begins to charge" in told
    assert "no robot fails (it does not work): from 5 to " in told
    assert told.splitlines()[-2].endswith("of 1 requests: 1 done")
    assert report.exists()


async def test_a_wrong_file_is_told_with_its_line(tmp_path: Path) -> None:
    wrong = tmp_path / "requests.yaml"
    wrong.write_text("requests:\n  - {kind: go_to_room, name: r, place: 101}\n")
    code, _, complaints = await run(tmp_path, str(SCENE), str(wrong))
    assert code == 2
    assert f"{wrong}:2: 'requests.0.go_to_room.place' must be text" in complaints
    assert "Traceback" not in complaints
