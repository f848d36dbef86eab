"""The command line: what it prints, where, and with which exit code."""

import csv
import json
import os
import signal
import sqlite3
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from uuid import UUID

import cv2
import httpx
import numpy as np
import pytest
from broken_constraints import broken_constraints
from forked_mend import mend_command
from mcap.reader import make_reader
from recorded_service import RecordedService, recorded_events
from service_process import free_port
from shown_run import hello, poses, run_state
from untruths import kinds_of

from mend.server.cli import main
from mend.server.cli.check import kind_of_file
from mend.server.cli.local_user import local_user
from mend.server.documents import DocumentKind
from mend.server.journal import events as ev
from mend.server.journal.reader import JournalReader
from mend.server.journal.sqlite import SqliteJournal
from mend.server.poses.frame import encode, framed
from mend.server.poses.layout import lay_out
from mend.server.poses.record import layout_path, record_path
from mend.tasks.library import TREES

EXAMPLES = Path(__file__).parents[2] / "examples"
TASKS = EXAMPLES / "tasks"
SCENE = """\
name: bench
objects:
  cup: {color: [1.0, 0.1, 0.1], size: [0.05, 0.05, 0.08], pose: {x: 0.5, y: 0.0}}
places:
  shelf: {pose: {x: 0.5, y: 0.3}}
"""
SCENARIO = """\
name: quiet
tree: eket
answers: [yes, no]
"""
TASK = """\
name: just_one
scene: bench
tree:
  then:
    - {behavior: pick_and_place, object: cup, place: shelf}
"""


@dataclass
class Outcome:
    code: int
    out: str
    err: str


Mend = Callable[..., Outcome]


def write_file(folder: Path, text: str) -> Path:
    """A file with this text, beside a scene that it may name."""
    (folder / "scenes").mkdir()
    (folder / "scenes" / "bench.yaml").write_text(SCENE)
    file = folder / "some.yaml"
    file.write_text(text)
    return file


@pytest.fixture
def data_dir(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where the command keeps its data; nothing of the developer's environment is used."""
    for name in list(os.environ):
        if name.startswith("MEND_"):
            monkeypatch.delenv(name)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    monkeypatch.setenv("COLUMNS", "200")
    return tmp_path / "mend"


@pytest.fixture
def mend(
    data_dir: Path,  # noqa: ARG001 - keeps commands away from real data
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> Mend:
    """Runs the command in this process."""

    def call(*arguments: str) -> Outcome:
        monkeypatch.setattr(sys, "argv", ["mend", *arguments])
        with pytest.raises(SystemExit) as ended:
            main()
        captured = capsys.readouterr()
        code = ended.value.code
        return Outcome(code if isinstance(code, int) else 0, captured.out, captured.err)

    return call


@pytest.fixture
def service(monkeypatch: pytest.MonkeyPatch) -> Callable[..., RecordedService]:
    """Replaces the real service by one that plays a recording."""

    def install(events: Sequence[ev.Event] | None = None, **options: Any) -> RecordedService:
        recorded = RecordedService(recorded_events() if events is None else events, **options)
        monkeypatch.setattr("mend.server.composition.open_service", recorded.open)
        return recorded

    return install


def ended_by(kind: Any, **fields: Any) -> list[ev.Event]:
    """The recording with another end."""
    *events, last = recorded_events()
    return [*events, kind(time=last.time, wall_time=last.wall_time, run=last.run, **fields)]


# --- All commands -----------------------------------------------------------------------------


def test_version_is_said(mend: Mend) -> None:
    outcome = mend("--version")
    assert outcome.code == 0
    assert outcome.out.startswith("mend 0.")


def test_help_names_every_command(mend: Mend) -> None:
    outcome = mend("--help")
    commands = "run serve check trees scenarios schema schedule replay train-colors"
    assert all(f"\n  {each} " in outcome.out for each in commands.split())
    summaries = outcome.out.partition("Commands:")[2]
    assert "..." not in summaries


@pytest.mark.parametrize(
    "arguments",
    [
        ["fly"],
        ["run"],
        ["run", "eket", "--speed", "fast"],
        ["run", "eket", "--speed", "-1"],
        ["run", "eket", "--speed", "nan"],
        ["run", "eket", "--seed", "x"],
        ["run", "eket", "--seed", "-3"],
        ["run", "eket", "--answers", "yes,maybe"],
        ["run", "eket", "--answers", ""],
        ["run", "eket", "--interventions", "always"],
        ["run", "eket", "--max-attempts", "0"],
        ["run", "eket", "--option", "light"],
        ["run", "eket", "--option", "=1"],
        ["run", "eket", "--option", "light=1", "--option", "light=0"],
        ["run", "eket", "--scenario", "no_such"],
        ["run", "nowhere"],
        ["run", "no_such_file.yaml"],
        ["run", "./eket"],
        ["run", ""],
        ["run", "x" * 65],
        ["run", "eket", "--report", "/dev/null/report.html"],
        ["run", "eket", "--journal", "/dev/null/journal.sqlite"],
        ["check", "no_such_file.yaml"],
        ["check", "."],
        ["schema", "pictures"],
        ["replay", "00000000"],
        ["replay", ""],
        ["replay", "ab", "--journal", "no_such.sqlite"],
        ["train-colors", "out.npz"],
        ["train-colors", "out.npz", "--images", "a", "--scene", "b"],
        ["train-colors", "out.txt", "--images", "."],
        ["train-colors", "out.npz", "--images", "no_such_folder"],
        ["train-colors", "out.npz", "--scene", "no_such_scene.yaml"],
        ["serve", "--port", "70000"],
        ["serve", "--host", "0.0.0.0"],
        ["serve", "--config", "no_such.toml"],
    ],
)
def test_wrong_input_is_told_on_stderr_and_nothing_begins(
    mend: Mend, service: Callable[..., RecordedService], arguments: list[str]
) -> None:
    recorded = service()
    outcome = mend(*arguments)
    assert outcome.code == 2
    assert outcome.out == ""
    assert outcome.err.strip()
    assert "Traceback" not in outcome.err
    assert not recorded.requests


def test_a_wrong_setting_in_the_environment_is_told(
    mend: Mend, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MEND_PROT", "1")
    outcome = mend("serve")
    assert outcome.code == 2
    assert "MEND_PROT" in outcome.err


# --- run --------------------------------------------------------------------------------------


def test_run_tells_the_transcript_and_exits_with_0_when_the_task_finished(
    mend: Mend, service: Callable[..., RecordedService]
) -> None:
    service()
    outcome = mend("run", "eket", "--world", "tabletop", "--scenario", "eket_paper")
    assert outcome.code == 0
    assert outcome.err == ""
    assert "robot: I dropped the pink bar. Shall I try again?\n" in outcome.out
    assert "helper (script): no\n" in outcome.out
    assert "green_leg: 1 above pick · 2 pick · 3 close gripper" in outcome.out
    assert outcome.out.endswith("the run has finished: the task is done\n")
    assert "\x1b" not in outcome.out


def test_json_is_one_event_on_each_line_and_nothing_else(
    mend: Mend, service: Callable[..., RecordedService], tmp_path: Path
) -> None:
    service()
    report = tmp_path / "run.html"
    outcome = mend("run", "eket", "--json", "--report", str(report))
    events = [ev.any_event.validate_json(line) for line in outcome.out.splitlines()]
    assert [type(each) for each in events] == [type(each) for each in recorded_events()]
    assert [each.seq for each in events] == list(range(1, len(events) + 1))
    assert report.read_text().startswith("<!doctype html>")


@pytest.mark.parametrize(
    ("end", "sentence"),
    [
        ((ev.RunFailed, {"reason": "'top' could not be done"}), "'top' could not be done"),
        ((ev.RunAborted, {"reason": "enough"}), "enough"),
    ],
)
def test_a_task_that_does_not_finish_exits_with_1(
    mend: Mend, service: Callable[..., RecordedService], end: Any, sentence: str
) -> None:
    kind, fields = end
    service(ended_by(kind, **fields))
    told, as_json = mend("run", "eket"), mend("run", "eket", "--json")
    assert (told.code, as_json.code) == (1, 1)
    assert told.err == ""
    assert sentence in told.out
    assert sentence in as_json.err


def test_a_run_that_stops_for_a_fault_of_ours_is_told_with_its_journal(
    mend: Mend, service: Callable[..., RecordedService]
) -> None:
    recorded = service(recorded_events()[:20], stops=True)
    outcome = mend("run", "eket")
    assert outcome.code == 1
    assert "fault of Mend's own" in outcome.err
    assert str(recorded.settings[0].journal_path) in outcome.err


def test_ctrl_c_aborts_the_run_and_exits_with_130(
    mend: Mend, service: Callable[..., RecordedService]
) -> None:
    service(recorded_events()[:20], started=lambda: os.kill(os.getpid(), signal.SIGINT))
    outcome = mend("run", "eket")
    assert outcome.code == 130
    assert outcome.out.endswith("the run was aborted: by a person\n")


def test_options_become_the_request(mend: Mend, service: Callable[..., RecordedService]) -> None:
    recorded = service()
    words = (
        "run eket --world tabletop --seed 7 --speed max --answers yes,no,silence "
        "--interventions random --max-attempts 5 --no-person "
        "--option camera_noise=4 --option renderer=fast --option on=true"
    )
    mend(*words.split())
    (request,) = recorded.requests
    assert request.model_dump(exclude_defaults=True) == {
        "tree": "eket",
        "world": "tabletop",
        "seed": 7,
        "speed": "max",
        "answers": ["yes", "no", "silence"],
        "interventions": "random",
        "max_attempts": 5,
        "person": {"acts": False},
        "world_options": {"camera_noise": 4, "renderer": "fast", "on": True},
    }


@pytest.mark.parametrize("answers", ["random", "none"])
def test_answers_may_be_left_to_chance_or_silence(
    mend: Mend, service: Callable[..., RecordedService], answers: str
) -> None:
    recorded = service()
    mend("run", "eket", "--answers", answers)
    assert recorded.requests[0].answers == answers


def test_nobody_is_asked_where_nobody_sits_at_a_terminal(
    mend: Mend, service: Callable[..., RecordedService]
) -> None:
    recorded = service()
    mend("run", "eket")
    assert recorded.requests[0].answers == "none"


def test_a_run_has_a_service_of_its_own_that_nobody_else_can_use(
    mend: Mend, service: Callable[..., RecordedService], data_dir: Path
) -> None:
    recorded = service()
    mend("run", "eket")
    mend("run", "eket")
    first, second = recorded.settings
    assert (first.host, first.port) == ("127.0.0.1", 0)
    assert first.token is not None
    assert first.token != second.token
    assert first.journal_path != second.journal_path
    assert first.journal_path.parent == data_dir / "runs"
    assert (first.speech_voice, first.speech_recognition) == ("none", False)


def test_a_task_file_is_run_under_its_own_name(
    mend: Mend, service: Callable[..., RecordedService], tmp_path: Path
) -> None:
    recorded = service()
    file = write_file(tmp_path, TASK)
    assert mend("run", str(file)).code == 0
    assert recorded.requests[0].tree == "just_one"
    assert recorded.given[0].texts == {
        DocumentKind.TREE: {"just_one": TASK},
        DocumentKind.SCENE: {"bench": SCENE},
    }


def test_a_task_file_with_mistakes_is_not_run(
    mend: Mend, service: Callable[..., RecordedService], tmp_path: Path
) -> None:
    recorded = service()
    file = write_file(tmp_path, TASK.replace("pick_and_place", "juggle"))
    outcome = mend("run", str(file))
    assert outcome.code == 2
    assert f"{file}:5: " in outcome.err
    assert not recorded.requests


# --- check ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "kind"), [(TASK, "task"), (SCENE, "scene"), (SCENARIO, "scenario")]
)
def test_check_tells_the_kinds_of_file_apart(
    mend: Mend, tmp_path: Path, text: str, kind: str
) -> None:
    file = write_file(tmp_path, text)
    outcome = mend("check", str(file))
    assert outcome.code == 0
    assert outcome.out.startswith(f"{file}: a {kind} file without mistakes")
    assert kind_of_file(text) == kind


@pytest.mark.parametrize(
    ("text", "world", "asked"),
    [
        (TASK, "tabletop", " in the world 'tabletop'"),
        (SCENE, "tabletop", " in the world 'tabletop'"),
        (TASK, None, " in the worlds 'tabletop' and 'workcell'"),
        (SCENARIO, None, ""),
    ],
)
def test_check_names_the_worlds_that_were_asked(
    mend: Mend, tmp_path: Path, text: str, world: str | None, asked: str
) -> None:
    file = write_file(tmp_path, text)
    outcome = mend("check", str(file), *(("--world", world) if world else ()))
    assert outcome.out.endswith(f"file without mistakes{asked}\n")


STEP_TWELVE = """\
name: late
tree: eket
interventions:
  - when: {object: pink_bar, step: 12}
    do: {act: steal, object: pink_bar}
"""


@pytest.mark.parametrize("command", ["check {file}", "run eket --scenario {file}"])
def test_a_scenario_that_waits_for_a_step_that_there_is_not_is_refused_with_its_line(
    mend: Mend, tmp_path: Path, command: str
) -> None:
    file = write_file(tmp_path, STEP_TWELVE)
    outcome = mend(*command.format(file=file).split())
    assert outcome.code != 0
    assert f"{file}:4: interventions[0].when names step 12 for 'pink_bar', but " in outcome.err


def test_a_scenario_for_a_tree_that_there_is_not_is_refused_with_its_line(
    mend: Mend, tmp_path: Path
) -> None:
    file = write_file(tmp_path, STEP_TWELVE.replace("eket", "moon"))
    told = mend("check", str(file)).err
    assert f"{file}:2: there is no task tree 'moon'" in told
    assert f"'{tmp_path / 'moon.yaml'}'" in told
    assert "--tree" in told
    refused = mend("run", "eket", "--scenario", str(file))
    assert refused.code == 2
    assert f"{file}:2: the scenario is for the task tree 'moon', not 'eket'" in refused.err


def test_the_tree_of_a_scenario_is_found_above_it_or_where_it_is_said_to_be(
    mend: Mend, tmp_path: Path
) -> None:
    (tmp_path / "scripts").mkdir()
    file = tmp_path / "scripts" / "script.yaml"
    file.write_text("name: script\ntree: moon\nanswers: [yes]\n".replace("yes", "'yes'"))
    tree = TREES.read("eket").replace("name: eket", "name: moon", 1)
    (tmp_path / "moon.yml").write_text(tree)
    assert mend("check", str(file)).code == 0
    (tmp_path / "moon.yml").rename(tmp_path / "elsewhere.yaml")
    assert mend("check", str(file)).code == 1
    assert mend("check", str(file), "--tree", str(tmp_path / "elsewhere.yaml")).code == 0
    assert "not 'eket'" in mend("check", str(file), "--tree", "eket").err


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (TASK.replace("pick_and_place", "juggle"), 5),
        (TASK.replace("object", "thing"), 5),
        (TASK.replace("cup", "can"), 5),
        (TASK.replace("shelf", "moon"), 5),
        (TASK.replace("then", "than"), 3),
        (TASK.replace("tree", "tre"), 1),
        (TASK.replace("bench", "nowhere"), 2),
        (SCENE.replace("0.08]", "-1]"), 3),
        (SCENE.replace("pose: {x: 0.5, y: 0.3}", "pose: {x: far}"), 5),
        (SCENARIO.replace("yes, no", "perhaps"), 3),
        (SCENARIO + "interventions: [{do: {act: explode}}]\n", 4),
        (SCENARIO.replace("tree: eket", "tree: 3"), 2),
        ("tree: [}\n", 1),
        ("a: &a [*a]\n", 1),
    ],
)
def test_check_names_each_mistake_with_file_and_line(
    mend: Mend, tmp_path: Path, text: str, line: int
) -> None:
    file = write_file(tmp_path, text)
    outcome = mend("check", str(file))
    assert outcome.code == 1
    assert outcome.out == ""
    assert any(each.startswith(f"mend: {file}:{line}: ") for each in outcome.err.splitlines())


@pytest.mark.parametrize("content", [b"", b"\xff\xfe\x00", b"[" * 100_000, b"- 1\n", b"null"])
def test_check_survives_files_that_are_none(mend: Mend, tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "file.yaml"
    file.write_bytes(content)
    outcome = mend("check", str(file))
    assert outcome.code in (1, 2)
    assert str(file) in outcome.err


# --- Lists and schemas ------------------------------------------------------------------------


def test_trees_and_scenarios_are_listed_as_lines_with_tabs(mend: Mend) -> None:
    trees = [line.split("\t") for line in mend("trees").out.splitlines()]
    scenarios = [line.split("\t") for line in mend("scenarios").out.splitlines()]
    assert "eket" in [row[0] for row in trees]
    assert ["eket_paper", "eket"] in [row[:2] for row in scenarios]
    assert {row[1] for row in scenarios} <= {row[0] for row in trees}


@pytest.mark.parametrize("name", ["openapi", "asyncapi", "events", "task", "scene", "scenario"])
def test_every_schema_is_json(mend: Mend, name: str) -> None:
    outcome = mend("schema", name)
    assert outcome.code == 0
    assert isinstance(json.loads(outcome.out), dict)


def test_the_schema_of_events_has_every_type(mend: Mend) -> None:
    kinds = set(json.loads(mend("schema", "events").out)["discriminator"]["mapping"])
    assert {each.type for each in recorded_events() if hasattr(each, "type")} <= kinds


# --- replay -----------------------------------------------------------------------------------


def played(mend: Mend, service: Callable[..., RecordedService]) -> str:
    """Run once; returns the run's id."""
    service()
    first = ev.any_event.validate_json(mend("run", "eket", "--json").out.splitlines()[0])
    return str(first.run)


def test_replay_tells_what_run_told(mend: Mend, service: Callable[..., RecordedService]) -> None:
    service()
    live = mend("run", "eket").out
    run = live.split()[2]
    assert mend("replay", run).out == live


def test_replay_takes_the_beginning_of_an_id_and_writes_the_report(
    mend: Mend, service: Callable[..., RecordedService], tmp_path: Path
) -> None:
    run = played(mend, service)
    report = tmp_path / "deep" / "report.html"
    outcome = mend("replay", run[:6], "--json", "--report", str(report))
    assert outcome.code == 0
    lines = outcome.out.splitlines()
    assert [ev.any_event.validate_json(line).seq for line in lines] == list(
        range(1, len(recorded_events()) + 1)
    )
    assert "data:image/jpeg;base64" in report.read_text()


@pytest.mark.parametrize("form", ["csv", "mcap"])
def test_export_writes_a_run_as_a_file(
    mend: Mend, service: Callable[..., RecordedService], tmp_path: Path, form: str
) -> None:
    run = played(mend, service)
    path = tmp_path / "deep" / f"run.{form}"
    outcome = mend("export", run[:6], "--format", form, "--output", str(path))
    assert (outcome.code, outcome.out) == (0, f"{path}\n")
    numbers = list(range(1, len(recorded_events()) + 1))
    if form == "csv":
        rows = csv.DictReader(path.read_text().splitlines())
        assert [int(row["seq"]) for row in rows] == numbers
    else:
        with path.open("rb") as file:
            read = list(make_reader(file).iter_messages(topics=["/events"]))
        assert [json.loads(message.data)["seq"] for _, _, message in read] == numbers
    assert [each.name for each in path.parent.iterdir()] == [path.name]


def test_export_has_where_everything_was_recorded_to_be(
    mend: Mend, service: Callable[..., RecordedService], tmp_path: Path, data_dir: Path
) -> None:
    run = UUID(played(mend, service))
    [journal] = (data_dir / "runs").glob("*.sqlite")
    shows = hello().shows
    assert shows is not None
    poses_of = journal.with_suffix(".poses")
    poses_of.mkdir()
    layout_path(poses_of, run).write_text(
        lay_out(run_state(run), hello(), shows, None).model_dump_json()
    )
    record_path(poses_of, run).write_bytes(framed([encode(0, 1.0, poses())]))
    path = tmp_path / "run.mcap"
    assert mend("export", str(run), "--format", "mcap", "-o", str(path)).code == 0
    with path.open("rb") as file:
        topics = {channel.topic for _, channel, _ in make_reader(file).iter_messages()}
    assert {"/tf", "/scene", "/joints"} <= topics


def test_export_of_a_run_that_there_is_not_writes_nothing(mend: Mend, tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    outcome = mend("export", "abc", "--format", "csv", "-o", str(path))
    assert outcome.code == 2
    assert "there is no run 'abc'" in outcome.err
    assert not path.exists()


def test_replay_asks_for_more_of_an_id_that_fits_several_runs(
    mend: Mend, service: Callable[..., RecordedService], monkeypatch: pytest.MonkeyPatch
) -> None:
    ids = iter([UUID("aa" + "0" * 30), UUID("ab" + "0" * 30)])
    monkeypatch.setattr("recorded_service.uuid4", lambda: next(ids))
    played(mend, service)
    played(mend, service)
    outcome = mend("replay", "a")
    assert outcome.code == 2
    assert "say more of it" in outcome.err
    assert mend("replay", "ab").code == 0


def test_replay_says_which_event_of_a_poisoned_journal_cannot_be_read(
    mend: Mend, service: Callable[..., RecordedService], tmp_path: Path
) -> None:
    run = played(mend, service)
    (path,) = tmp_path.rglob("*.sqlite")
    with sqlite3.connect(path) as connection:
        connection.execute("UPDATE events SET body = json_set(body, '$.time', NULL) WHERE seq = 3")
    outcome = mend("replay", run)
    assert outcome.code == 2
    assert "event 3 of" in outcome.err
    assert "Traceback" not in outcome.err


def test_replay_reads_a_journal_that_is_being_written(
    mend: Mend, service: Callable[..., RecordedService]
) -> None:
    run = played(mend, service)
    (journal,) = Path(os.environ["XDG_DATA_HOME"]).glob("mend/runs/*.sqlite")
    writer = SqliteJournal(journal)
    try:
        assert mend("replay", run, "--journal", str(journal)).code == 0
    finally:
        writer.close()


def test_a_file_that_is_no_journal_is_told(mend: Mend, tmp_path: Path) -> None:
    file = tmp_path / "notes.sqlite"
    file.write_text("these are notes, and long enough to be mistaken for something else" * 40)
    outcome = mend("replay", "ab", "--journal", str(file))
    assert outcome.code == 2
    assert "is not a journal" in outcome.err


def test_a_reader_changes_nothing(
    mend: Mend, service: Callable[..., RecordedService], data_dir: Path
) -> None:
    played(mend, service)
    (journal,) = (data_dir / "runs").glob("*.sqlite")
    before = journal.read_bytes()
    with JournalReader(journal) as reader:
        (run,) = reader.runs()
        assert len(reader.events(run)) == len(recorded_events())
    assert journal.read_bytes() == before


# --- train-colors -----------------------------------------------------------------------------


@pytest.mark.parametrize("world", ["tabletop", "workcell"])
def test_colors_are_learned_from_a_rendered_scene(mend: Mend, tmp_path: Path, world: str) -> None:
    if world == "workcell":
        pytest.importorskip("pybullet")
    scene, model = tmp_path / "scene.yaml", tmp_path / "made" / "colors.npz"
    scene.write_text(SCENE)
    outcome = mend("train-colors", str(model), "--scene", str(scene), "--world", world)
    assert (outcome.code, outcome.out) == (0, f"{model}: the colours of cup\n")
    assert model.is_file()


def test_colors_are_learned_from_supplied_pictures(mend: Mend, tmp_path: Path) -> None:
    folder = tmp_path / "images" / "cup"
    folder.mkdir(parents=True)
    picture = np.zeros((40, 40, 4), np.uint8)
    picture[10:30, 10:30] = (30, 30, 220, 255)
    cv2.imwrite(str(folder / "one.png"), picture)
    model = tmp_path / "colors.npz"
    outcome = mend("train-colors", str(model), "--images", str(tmp_path / "images"))
    assert (outcome.code, outcome.out) == (0, f"{model}: the colours of cup\n")


# --- Live robots ------------------------------------------------------------------------------


def test_who_stands_nowhere_in_the_scene_is_told_before_anybody_is_waited_for(
    mend: Mend, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MEND_PORT", str(free_port()))
    kit = ("run", "kit", "--scene", str(EXAMPLES / "two_arms" / "kit_for_two.yaml"))
    live = (*kit, "--world", "live", "--robot")
    wrong = mend(*live, "lft=demo")
    lacking = mend(*live, "demo")
    both = mend(*live, "left=a", "--robot", "b")
    assert [(each.code, each.out) for each in (wrong, lacking, both)] == [(2, "")] * 3
    assert "the scene 'kit_for_two' has no robot 'lft'; it has 'left', 'right'" in wrong.err
    assert "'robots' lists 1, but in the scene 'kit_for_two' stand 'left', 'right'" in lacking.err
    assert "--robot is 'b'; where one robot is PLACE=NAME all have to be" in both.err


# --- As a process -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("given", "why"),
    [
        (["--tls-cert", "nowhere.pem"], "'tls_certificate' and 'tls_key' go together"),
        (
            ["--tls-cert", "nowhere.pem", "--tls-key", "nowhere.pem"],
            "'tls_certificate' (nowhere.pem) cannot be read: No such file",
        ),
    ],
)
def test_tls_files_that_cannot_be_used_end_the_start_with_a_sentence(
    mend: Mend, given: list[str], why: str
) -> None:
    outcome = mend("serve", "--port", "0", *given)
    assert outcome.code == 2
    assert why in " ".join(outcome.err.split())


COMMAND = [sys.executable, "-c", "from mend.server.cli import main; main()"]


def begin(data_dir: Path, *arguments: str) -> subprocess.Popen[str]:
    """Start the command as a process of its own."""
    return subprocess.Popen(
        [*COMMAND, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "XDG_DATA_HOME": str(data_dir.parent)},
    )


@pytest.mark.slow
def test_the_command_stays_quiet_when_its_reader_goes_away(data_dir: Path) -> None:
    with begin(data_dir, "schema", "events") as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert process.stderr.read() == ""
        assert process.wait() != 0


@pytest.mark.slow(3)
@pytest.mark.usefixtures("data_dir")
async def test_the_papers_scenario_is_run_for_real_and_finishes() -> None:
    arguments = "run eket --world tabletop --scenario eket_paper --speed max --seed 7 --json"
    async with mend_command(*arguments.split()) as command:
        code, out, err = await command.outcome()
    assert (code, err) == (0, "")
    events = [ev.any_event.validate_json(line) for line in out.splitlines()]
    assert [(each.issue, each.object) for each in events if isinstance(each, ev.IssueRaised)] == [
        ("dropped", "pink_bar"),
        ("dropped", "yellow_bar"),
        ("positioning", "yellow_bar"),
        ("missed", "blue_leg"),
        ("positioning", "blue_leg"),
        ("unreachable", "purple_top"),
    ]
    assert [str(each.resolution) for each in events if isinstance(each, ev.Resolved)] == [
        "human_finish",
        "robot_retry",
        "collab_finish",
        "robot_retry",
        "collab_finish",
        "robot_finish",
    ]
    assert all(each.picture for each in events if isinstance(each, ev.IssueRaised))
    started, finished = events[0], events[-1]
    assert isinstance(started, ev.RunStarted)
    assert isinstance(finished, ev.RunFinished)
    assert finished.missing == []
    assert broken_constraints(events, kinds_of(started)) == []


@pytest.mark.slow(3)
async def test_ctrl_c_aborts_a_real_run_which_its_journal_then_tells(data_dir: Path) -> None:
    arguments = "run eket --world tabletop --answers none --json"
    async with mend_command(*arguments.split()) as command:
        first = ev.any_event.validate_json(await command.told.readline())
        command.process.send_signal(signal.SIGINT)
        code, out, err = await command.outcome()
    assert (code, err) == (130, f"mend: the run was aborted: by {local_user()}\n")
    assert isinstance(ev.any_event.validate_json(out.splitlines()[-1]), ev.RunAborted)
    (journal,) = (data_dir / "runs").glob("*.sqlite")
    with JournalReader(journal) as reader:
        assert isinstance(reader.events(first.run)[-1], ev.RunAborted)


@pytest.mark.slow(2)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.usefixtures("data_dir")
async def test_serve_says_where_it_listens_and_stops_when_told(number: signal.Signals) -> None:
    async with mend_command("serve", "--port", "0") as command:
        url = (await command.says("Mend listens on")).split()[3].rstrip(";")
        async with httpx.AsyncClient(base_url=url) as client:
            assert (await client.get("/healthz")).status_code == 200
        command.process.send_signal(number)
        code, _, err = await command.outcome()
    assert code == 0
    assert "Traceback" not in err


# --- scenes and scenarios of one's own -----------------------------------------------------------


@pytest.mark.parametrize("file", sorted(TASKS.rglob("*.yaml")), ids=lambda file: file.name)
def test_the_examples_are_without_mistakes(mend: Mend, file: Path) -> None:
    outcome = mend("check", str(file))
    assert (outcome.code, outcome.err) == (0, "")


def test_scenes_are_listed(mend: Mend) -> None:
    rows = [line.split("\t") for line in mend("scenes").out.splitlines()]
    assert ["eket", "6", "6"] in rows


def test_a_scene_and_a_scenario_may_be_files(
    mend: Mend, service: Callable[..., RecordedService]
) -> None:
    recorded = service()
    scene, scenario = TASKS / "scenes/small_flat.yaml", TASKS / "clumsy_evening.yaml"
    task = TASKS / "shelf.yaml"
    assert mend("run", str(task), "--scene", str(scene), "--scenario", str(scenario)).code == 0
    (request,) = recorded.requests
    assert (request.tree, request.scene, request.scenario) == (
        "shelf",
        "small_flat",
        "clumsy_evening",
    )
    assert request.answers == ["yes"] * 6
    assert recorded.given[0].texts == {
        DocumentKind.TREE: {"shelf": task.read_text()},
        DocumentKind.SCENE: {"small_flat": scene.read_text()},
        DocumentKind.SCENARIO: {"clumsy_evening": scenario.read_text()},
    }


def test_an_option_beyond_its_limit_is_told_with_what_would_be_right(mend: Mend) -> None:
    outcome = mend("run", "eket", "--max-attempts", "101", "--speed", "2000")
    assert outcome.code == 2
    assert "--max-attempts must be less than or equal to 100, but it is 101" in outcome.err
    assert "--speed must be less than or equal to 1000 or 'max', but it is 2000" in (outcome.err)


def test_a_scene_may_be_named(mend: Mend, service: Callable[..., RecordedService]) -> None:
    recorded = service()
    assert mend("run", "eket", "--scene", "eket").code == 0
    assert mend("run", str(TASKS / "shelf.yaml"), "--scene", "small_flat").code == 0
    assert [each.scene for each in recorded.requests] == ["eket", "small_flat"]


@pytest.mark.parametrize(
    ("option", "value", "sentence"),
    [
        ("--scene", "nowhere", "there is no scene 'nowhere' in the library"),
        ("--scene", "no_such.yaml", "no_such.yaml: the file cannot be read"),
        ("--scenario", "nothing", "there is no scenario 'nothing' in the library"),
        ("--scenario", "no_such.yaml", "no_such.yaml: the file cannot be read"),
    ],
)
def test_a_scene_or_scenario_that_is_not_there_is_told(
    mend: Mend, service: Callable[..., RecordedService], option: str, value: str, sentence: str
) -> None:
    recorded = service()
    outcome = mend("run", "eket", option, value)
    assert outcome.code == 2
    assert sentence in outcome.err
    assert not recorded.requests


def test_what_a_robot_cannot_do_is_told_with_world_file_and_line(
    mend: Mend, tmp_path: Path
) -> None:
    task = write_file(tmp_path, TASK)
    scene = tmp_path / "scenes" / "bench.yaml"
    scene.write_text(SCENE.replace("[0.05, 0.05, 0.08]", "[0.09, 0.09, 0.08]"))
    for file in (task, scene):
        outcome = mend("check", str(file), "--world", "tabletop")
        assert outcome.code == 1
        assert f"{scene}:3: in the world 'tabletop': " in outcome.err
        assert "takes 12 to 78 mm" in outcome.err
    assert mend("check", str(task), "--world", "mars").code == 2


def test_a_run_that_the_robot_cannot_do_is_refused(mend: Mend, tmp_path: Path) -> None:
    task = write_file(tmp_path, TASK)
    scene = tmp_path / "scenes" / "bench.yaml"
    scene.write_text(SCENE.replace("[0.05, 0.05, 0.08]", "[0.09, 0.09, 0.08]"))
    outcome = mend("run", str(task), "--world", "tabletop", "--json")
    assert (outcome.code, outcome.out) == (2, "")
    assert "cannot do the tree 'just_one' in the scene 'bench'" in outcome.err
    assert f"mend: {scene}:3: " in outcome.err
    assert "takes 12 to 78 mm" in outcome.err


def test_a_run_with_an_option_that_its_world_has_not_is_refused(mend: Mend) -> None:
    outcome = mend("run", "eket", "--world", "tabletop", "--json", "--option", "camera_nois=4")
    assert (outcome.code, outcome.out) == (2, "")
    told = "the world 'tabletop' has no option 'camera_nois'; it has 'camera_noise', "
    assert told in outcome.err


@pytest.mark.slow(3)
async def test_a_random_scene_is_printed_with_its_tree_and_can_be_run(
    mend: Mend, tmp_path: Path
) -> None:
    words = ("scene", "random", "--seed", "5", "--parts", "3", "--world", "tabletop")
    scene, tree = tmp_path / "scenes" / "random_5.yaml", tmp_path / "random_5.yaml"
    scene.parent.mkdir()
    scene.write_text(mend(*words).out)
    tree.write_text(mend(*words, "--tree").out)
    assert mend("check", str(scene), "--world", "tabletop").code == 0
    assert mend("check", str(tree), "--world", "tabletop").code == 0
    run = ("run", str(tree), "--world", "tabletop", "--speed", "max", "--answers", "none")
    async with mend_command(*run) as command:
        code, out, err = await command.outcome()
    assert (code, err) == (0, ""), out
