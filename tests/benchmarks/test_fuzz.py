"""A seeded sample of what `benchmarks/fuzz.py` tries, and that it would find something."""

from pathlib import Path

import pytest
from fuzz_bench import bench
from fuzz_files import Found, Reader, fuzz_reader, readers, wrong_with
from fuzz_helpers import fuzz_helper
from fuzz_mutations import Mutator
from fuzz_requests import fuzz_requests, fuzz_strangers
from fuzz_robots import fuzz_robot
from fuzz_said import said
from websockets.asyncio.client import connect
from websockets.asyncio.server import ServerConnection, serve

from mend.server.access.admission import Admission
from mend.server.access.principal import ANYBODY, Caller
from mend.server.cli.failures import CommandLineError

FEW, MANY = 4, 30
"""Of files that take long to read, and of others."""

SLOW = ("task tree", "scene", "scenario", "delivery", "delivery of any format")


@pytest.mark.slow
def test_mutated_files_are_taken_or_refused_in_sentences(tmp_path: Path) -> None:
    made, used = tmp_path / "made", tmp_path / "used"
    made.mkdir()
    used.mkdir()
    for reader in readers(made):
        mutations = FEW if reader.name in SLOW else MANY
        found = fuzz_reader(reader, mutations, 7, used)
        assert found.tried == mutations
        assert found.findings == [], str(found.findings[0])


@pytest.mark.slow
async def test_mutated_requests_and_messages_do_no_harm() -> None:
    async with bench() as made:
        for fuzz, mutations in (
            (fuzz_requests, 30), (fuzz_strangers, 30), (fuzz_helper, 50), (fuzz_robot, 50),
        ):  # fmt: skip
            found = await fuzz(made, mutations, 7)
            assert found.tried > 0.9 * mutations
            assert found.refused > mutations / 3
            assert found.findings == [], str(found.findings[0])


@pytest.mark.slow
async def test_a_service_that_lets_strangers_do_what_others_may_is_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("mend.server.access.access.REFUSED", Admission(Caller(ANYBODY)))
    async with bench() as made:
        found = await fuzz_strangers(made, 120, 7)
    assert any("without a credential" in each.sentence for each in found.findings)


@pytest.mark.parametrize("ends", [False, True])
async def test_what_is_answered_late_is_told_of_the_message_that_it_is_for(ends: bool) -> None:
    async def answer(socket: ServerConnection) -> None:
        assert [await socket.recv() for _ in range(2)] == ["sample", "question"]
        await socket.send('{"of": "sample"}')
        if not ends:
            await socket.send('{"of": "question"}')
            await socket.wait_closed()

    async with serve(answer, "127.0.0.1", 0) as server:
        port = next(iter(server.sockets)).getsockname()[1]
        async with connect(f"ws://127.0.0.1:{port}") as socket:
            told = await said(socket, ["sample", "question"], lambda each: each["of"] == "question")
    assert told == ['{"of": "sample"}']


def test_the_same_seed_draws_the_same() -> None:
    value = {"a": [1, {"b": "text"}], "c": None}
    drawn = [[Mutator(seed).of_json(value) for _ in range(1)] for seed in (1, 1, 2)]
    assert drawn[0] == drawn[1] != drawn[2]
    changed = Mutator(3)
    texts = {changed.of_json(value) for _ in range(200)}
    assert len(texts) > 150


@pytest.mark.parametrize(
    ("failure", "sentence"),
    [
        (KeyError("x"), "KeyError"),
        (MemoryError(), "there was not enough memory"),
        (CommandLineError(" "), "without a sentence"),
    ],
)
def test_what_must_not_be_is_found(tmp_path: Path, failure: Exception, sentence: str) -> None:
    def read(_: Path) -> None:
        raise failure

    found = fuzz_reader(Reader("broken", "file", [b"text"], read), 3, 1, tmp_path)
    assert [sentence in str(each) for each in found.findings] == [True] * 3


def test_a_traceback_and_a_changed_file_are_found(tmp_path: Path) -> None:
    path = tmp_path / "file"

    def write(_: Path) -> None:
        path.write_text("something else")

    def tell(_: Path) -> None:
        print("Traceback (most recent call last):")  # noqa: T201

    changing = fuzz_reader(Reader("changing", "file", [b"text"], write), 1, 1, tmp_path)
    assert "the file was changed" in str(changing.findings[0])
    assert "a traceback was written" in str(
        wrong_with(Reader("t", "file", [b""], tell), path, Found())
    )
