"""`mend building run`: robots meet the requests of a file, and each line of it is so."""

from pathlib import Path

import pytest
import yaml
from forked_mend import mend_command
from sampled import sample

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


async def test_a_wrong_file_is_told_with_its_line(tmp_path: Path) -> None:
    wrong = tmp_path / "requests.yaml"
    wrong.write_text("requests:\n  - {kind: go_to_room, name: r, place: 101}\n")
    code, _, complaints = await run(tmp_path, str(SCENE), str(wrong))
    assert code == 2
    assert f"{wrong}:2: 'requests.0.go_to_room.place' must be text" in complaints
    assert "Traceback" not in complaints
