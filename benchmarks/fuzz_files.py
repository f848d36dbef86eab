"""Every reader of files, with valid examples of what it reads."""

import asyncio
import contextlib
import io
import json
import logging
import shutil
import signal
import sqlite3
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, redirect_stderr, redirect_stdout
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any
from uuid import UUID

import yaml
from fuzz_mutations import YAML_TRICKS, Mutator

from mend.server.cli.failures import CommandLineError, told_plainly

ROOT = Path(__file__).parents[1]

SLOW_S = 20
"""Who reads a small file for so long hangs."""

LINES = 40
"""Of a log so many lines are enough to be read in no time."""


@dataclass(frozen=True)
class Finding:
    """Something that must not be: where, what, and what was read or sent."""

    target: str
    sentence: str
    sample: bytes

    def __str__(self) -> str:
        return f"{self.target}: {self.sentence} <- {self.sample[:200]!r}"


@dataclass
class Found:
    """How many mutations were tried, how many of them were refused, and what was found."""

    tried: int = 0
    refused: int = 0
    findings: list[Finding] = field(default_factory=list)

    def add(self, finding: Finding) -> None:
        self.findings.append(finding)


@dataclass(frozen=True)
class Reader:
    """What reads a file, and examples; `structured` ones are YAML or JSON."""

    name: str
    file: str
    examples: Sequence[bytes]
    read: Callable[[Path], object]
    structured: bool = False


class TooSlowError(Exception):
    """It takes too long."""


class Complaints(logging.Handler):
    """What is logged as an error, or with a traceback."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.tracebacks: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        if record.exc_info or "Traceback" in record.getMessage():
            self.tracebacks.append(self.format(record))


def mutated(reader: Reader, mutator: Mutator) -> bytes:
    """A mutation of one of the examples."""
    example = mutator.random.choice(reader.examples)
    if reader.structured and mutator.random.random() < 0.6:
        with contextlib.suppress(yaml.YAMLError):
            return mutator.of_json(_plain(example))
    if reader.structured and mutator.random.random() < 0.1:
        return mutator.random.choice(YAML_TRICKS).encode()
    if b"\0" in example:
        return mutator.of_bytes(example)
    return mutator.of_text(example)


@cache
def _plain(example: bytes) -> Any:
    return json.loads(json.dumps(yaml.safe_load(example), default=str))


def fuzz_reader(reader: Reader, mutations: int, seed: int, folder: Path) -> Found:
    """Have mutated files read: each is taken, or refused in sentences."""
    found, mutator = Found(), Mutator(seed)
    for number in range(mutations):
        sample = mutated(reader, mutator)
        for each in folder.iterdir():
            shutil.rmtree(each) if each.is_dir() else each.unlink()
        path = folder / reader.file
        path.write_bytes(sample)
        found.tried += 1
        wrong = wrong_with(reader, path, found)
        if wrong:
            found.add(Finding(f"{reader.name} #{number}", wrong, sample))
        elif path.is_file() and path.read_bytes() != sample:
            found.add(Finding(f"{reader.name} #{number}", "the file was changed", sample))
    return found


def wrong_with(reader: Reader, path: Path, found: Found) -> str | None:
    """What is wrong with how a file is read; None if nothing is."""
    complaints, out = Complaints(), io.StringIO()
    logging.getLogger().addHandler(complaints)
    try:
        with _patience(), redirect_stdout(out), redirect_stderr(out), told_plainly():
            reader.read(path)
    except CommandLineError as error:
        found.refused += 1
        if not str(error).strip():
            return "it was refused without a sentence"
        if len(str(error)) > 100_000:
            return f"it was refused with {len(str(error))} characters"
    except TooSlowError:
        return f"it was not read within {SLOW_S} s"
    except MemoryError:
        return "there was not enough memory"
    except BaseException as error:
        return f"{type(error).__name__}: {str(error)[:200]} {_where(error)}"
    finally:
        logging.getLogger().removeHandler(complaints)
    if complaints.tracebacks or "Traceback" in out.getvalue():
        return f"a traceback was written: {(complaints.tracebacks or [out.getvalue()])[0][-300:]}"
    return None


def _where(error: BaseException) -> str:
    frames = traceback.extract_tb(error.__traceback__)
    own = [each for each in frames if str(ROOT) in each.filename and ".venv" not in each.filename]
    at = (own or frames)[-1]
    return f"(in {Path(at.filename).name}:{at.lineno} {at.name})"


@contextlib.contextmanager
def _patience() -> Iterator[None]:
    def give_up(*_: object) -> None:
        raise TooSlowError

    before = signal.signal(signal.SIGALRM, give_up)
    signal.alarm(SLOW_S)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


# --- The readers ----------------------------------------------------------------------------------


def readers(folder: Path) -> list[Reader]:
    """Every reader; `folder` is for what examples are made in."""
    return [
        *_documents(),
        Reader("principals", "principals.yaml", [_principals(folder)], _read_principals, True),
        Reader("settings", "mend.toml", [SETTINGS], _read_settings),
        *_maps_and_logs(),
        *_instances(),
        *_journals(folder),
        *_poses(),
    ]


def _files(*patterns: str) -> list[bytes]:
    return [path.read_bytes() for pattern in patterns for path in sorted(ROOT.glob(pattern))]


def _documents() -> list[Reader]:
    from mend.server.cli.mistakes import (
        delivery_mistakes,
        scenario_mistakes,
        scene_mistakes,
        task_mistakes,
    )
    from mend.server.scene_checks import WorldChecks

    nowhere = WorldChecks({})
    kinds: list[tuple[str, Callable[..., Any], tuple[str, ...]]] = [
        ("task tree", task_mistakes, ("tasks/library/*.yaml", "examples/tasks/kit*.yaml")),
        ("scene", scene_mistakes, ("tasks/scenes/*.yaml", "examples/tasks/scenes/*.yaml")),
        ("scenario", scenario_mistakes, ("tasks/scenarios/*.yaml", "examples/tasks/clumsy*")),
        ("delivery", delivery_mistakes, ("examples/deliveries/*.yaml",)),
    ]

    def reading(mistakes: Callable[..., Any]) -> Callable[[Path], None]:
        def read(path: Path) -> None:
            found = mistakes(path, nowhere).mistakes
            if found:
                raise CommandLineError("\n".join(found))

        return read

    return [
        Reader(name, "file.yaml", _files(*patterns), reading(mistakes), True)
        for name, mistakes, patterns in kinds
    ]


def _principals(folder: Path) -> bytes:
    from mend.server.access.changes import PrincipalsEditor
    from mend.server.access.roles import Role

    path = folder / "example.yaml"
    editor = PrincipalsEditor(path, by="root")
    now = datetime(2026, 5, 4, 12, tzinfo=UTC)
    editor.add("anna", Role.HELPER, now, 90)
    editor.add("ada", Role.ADMIN, now)
    editor.open_enrolment("arm-1", now, 15)
    return path.read_bytes()


def _read_principals(path: Path) -> None:
    from mend.server.access.principals_file import read_principals

    read_principals(path)


SETTINGS = b"""\
host = "127.0.0.1"
port = 8080
token = "a-long-random-token"
help_window_s = 30.0
helpers = ["anna", "bert"]
allowed_hosts = ["mend.example.org"]
trusted_proxies = ["10.0.0.0/8"]
public_url = "https://mend.example.org"
record_poses = true
log_level = "info"

[limits]
answers = 100
head_s = 10.0

[keep]
days = 30

[mail]
host = "smtp.example.org"
sender = "mend@example.org"
operators = ["olga@example.org"]
"""


def _read_settings(path: Path) -> None:
    from mend.server.settings import load_settings

    load_settings(path)


CARMEN = b"""\
PARAM robot_front_laser_max 81.9
FLASER 5 1.0 2.0 3.0 4.0 5.0 0.0 0.0 0.0 0.1 0.1 0.0 976052857.333530 host 0.1
FLASER 5 1.1 2.1 3.1 4.1 5.1 0.1 0.0 0.0 0.2 0.1 0.0 976052857.533530 host 0.3
ODOM 0.1 0.0 0.0 0.1 0.0 0.0 976052857.6 host 0.4
"""
WEAN = b"".join(
    b"O 1.0 2.0 0.1 %d.0\nL %d.0 2.0 0.1 %d.0 2.0 0.1 " % (at, at, at)
    + b"120 " * 180
    + b"%d.5\n" % at
    for at in range(3)
)
MAP_JSON = b'[{"p0": {"x": 0, "y": 0}, "p1": {"x": 24.0, "y": 0}}]'


def _maps_and_logs() -> list[Reader]:
    from mend.localization.logs.reading import read_log
    from mend.maps.clean_up import clean_up
    from mend.maps.vector_map_file import read_vector_map

    drive = (ROOT / "examples/localization/drive.csv").read_bytes().split(b"\n")[:LINES]
    floor = _files("examples/localization/floor.vectormap.txt")
    short = [b"\n".join(each.split(b"\n")[:LINES]) for each in floor]

    def clean(path: Path) -> None:
        clean_up(read_vector_map(path))

    return [
        Reader("vector map (text)", "map.txt", short, clean),
        Reader("vector map (JSON)", "map.json", [MAP_JSON], clean, True),
        Reader("laser log (CSV)", "log.csv", [b"\n".join(drive)], read_log),
        Reader("laser log (CARMEN)", "log.txt", [CARMEN], read_log),
        Reader("laser log (Wean Hall)", "log.log", [WEAN], read_log),
    ]


LI_LIM = b"""\
3\t20\t1
0\t40\t50\t0\t0\t1236\t0\t0\t0
1\t45\t68\t10\t912\t967\t90\t0\t2
2\t45\t70\t-10\t825\t1000\t90\t1\t0
"""
TRANSFER = b"""\
nr nv nt capacity
1 1 1 10
node x y tw_start tw_end load
p0 10 0 0 10 3
d0 20 -3 0 100 -3
o0 0 0 0 100 0
e0 0 0 0 100 0
t0 5 5 0 100 0
"""


def _instances() -> list[Reader]:
    from mend.server.cli.delivery_files import read_delivery

    def read(path: Path) -> None:
        read_delivery(path, "auto", transfers=True)

    return [
        Reader("delivery or instance", "file.txt", [LI_LIM, TRANSFER], read),
        Reader(
            "delivery of any format", "d.yaml", _files("examples/deliveries/*.yaml"), read, True
        ),
    ]


def _journals(folder: Path) -> list[Reader]:
    from made_up_history import write_history

    from mend.server.cli.journal import check as check_journal
    from mend.server.journal.backup import restore
    from mend.server.journal.reader import JournalReader
    from mend.server.journal.sqlite import SqliteJournal

    path = folder / "example.db"
    write_history(path, 2, pictures=True)
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        connection.execute("PRAGMA journal_mode=DELETE")
    example = [path.read_bytes()]

    def put_back(backup: Path) -> None:
        target = backup.with_name("restored.db")
        try:
            restore(backup, target)
        except BaseException:
            if target.exists():
                raise AssertionError("a refused backup was put in the journal's place") from None
            raise

    def read(journal: Path) -> None:
        with JournalReader(journal) as reader:
            for run in reader.runs():
                reader.events(run)

    def open_and_read(journal: Path) -> None:
        async def everything() -> None:
            opened = SqliteJournal(journal.with_name(shutil.copy(journal, "copy.db")))
            try:
                await opened.read(0, 1000)
            finally:
                opened.close()

        with contextlib.chdir(journal.parent):
            asyncio.run(everything())

    def check(journal: Path) -> None:
        import typer

        with contextlib.suppress(typer.Exit):
            check_journal(journal)

    return [
        Reader("journal backup (restored)", "backup.db", example, put_back),
        Reader("journal (read)", "journal.db", example, read),
        Reader("journal (opened)", "journal.db", example, open_and_read),
        Reader("journal (checked)", "journal.db", example, check),
    ]


def _poses() -> list[Reader]:
    from mend.server.poses.record import PoseRecords

    run = UUID(int=7)

    def read(path: Path) -> None:
        async def everything() -> None:
            records = PoseRecords(path.parent)
            try:
                await records.read(run, 0.0, 1e9, 100)
                await records.last(run)
                await records.layout(run)
            finally:
                records.shut()

        asyncio.run(everything())

    layout = {
        "type": "layout", "run": str(run), "robot": "r", "model": None, "joints": ["a"],
        "objects": [{"name": "cup", "kind": "object", "shape": "box", "size_m": [0.1, 0.1, 0.1],
                     "knob_m": None, "color": [0.1, 0.6, 0.2]}],
        "places": [{"name": "left", "position": [0.6, 0.1, 0.7], "yaw": 0.0}],
        "table": None, "reach": None, "cameras": ["head"], "simulated": True, "rate_hz": 20.0,
    }  # fmt: skip
    frame = b"\x54\0\0\0" + bytes(84)
    return [
        Reader("recorded poses", f"{run}.poses", [frame * 5], read),
        Reader("recorded layout", f"{run}.layout.json", [json.dumps(layout).encode()], read, True),
    ]
