"""`mend building run`: robots meet the requests of a file, and each line of it is so."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from sampled import sample

MEND = str(Path(sys.executable).with_name("mend"))
EXAMPLES = Path(__file__).parents[2] / "examples" / "buildings"
SCENE, REQUESTS = EXAMPLES / "scenes" / "office_at_work.yaml", EXAMPLES / "requests.yaml"
ALL_NAMES = ("mail", "keys", "lunch", "guest", "visit")
NAMES = sample(("mail", "visit"), ALL_NAMES)
PATIENCE_S = 400.0


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    kept = {name: value for name, value in os.environ.items() if not name.startswith("MEND_")}
    return subprocess.run(
        [MEND, "building", "run", *arguments],
        env={**kept, "XDG_DATA_HOME": str(folder)},
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
    )


@pytest.mark.slow(8)
def test_the_shipped_requests_are_met(tmp_path: Path) -> None:
    shipped = yaml.safe_load(REQUESTS.read_text("utf-8"))["requests"]
    assert tuple(each["name"] for each in shipped) == ALL_NAMES
    wanted = tmp_path / "requests.yaml"
    wanted.write_text(yaml.safe_dump({"requests": [e for e in shipped if e["name"] in NAMES]}))
    exact = ("--option", "localizer=exact", "--option", "unmapped=0")
    done = run(tmp_path, str(SCENE), str(wanted), *exact)
    assert done.returncode == 0, done.stderr
    lines = [line[10:] for line in done.stdout.splitlines()]
    assert lines[-1] == f"of {len(NAMES)} requests: {len(NAMES)} done"
    assert "shutting down" not in done.stderr
    for name in NAMES:
        assert any(line.startswith(f"'{name}' is done") for line in lines)
    times = [float(line[:8]) for line in done.stdout.splitlines()]
    assert times == sorted(times)


def test_what_cannot_be_met_is_refused_with_when_it_could_be(tmp_path: Path) -> None:
    hasty = tmp_path / "requests.yaml"
    hasty.write_text("requests: [{kind: go_to_room, name: r, place: F3/305, latest_s: 2}]\n")
    done = run(tmp_path, str(SCENE), str(hasty))
    assert done.returncode == 1, done.stderr
    assert "refused: 'r' cannot be met" in done.stdout
    assert "it would be possible" in done.stdout
    assert done.stdout.splitlines()[-1].endswith("of 1 requests: 1 refused")


def test_a_wrong_file_is_told_with_its_line(tmp_path: Path) -> None:
    wrong = tmp_path / "requests.yaml"
    wrong.write_text("requests:\n  - {kind: go_to_room, name: r, place: 101}\n")
    done = run(tmp_path, str(SCENE), str(wrong))
    assert done.returncode == 2
    assert f"{wrong}:2: 'requests.0.go_to_room.place' must be text" in done.stderr
    assert "Traceback" not in done.stderr
