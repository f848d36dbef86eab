"""`mend access`: what it prints, and what it keeps."""

import json
import os
import sys
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from uuid import uuid4

import pytest

from mend.server.access.known_principals import KnownPrincipals
from mend.server.access.roles import Role
from mend.server.cli import main
from mend.server.cli.rows import print_rows
from mend.server.journal import events as ev
from mend.server.journal.journal import Entry
from mend.server.journal.sqlite import SqliteJournal

Mend = Callable[..., tuple[int, str, str]]


@pytest.fixture
def data_dir(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in list(os.environ):
        if name.startswith("MEND_"):
            monkeypatch.delenv(name)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    return tmp_path / "mend"


@pytest.fixture
def mend(
    data_dir: Path,  # noqa: ARG001 - keeps commands away from real data
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> Mend:
    def call(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["mend", "access", *arguments])
        with pytest.raises(SystemExit) as ended:
            main()
        said = capsys.readouterr()
        return int(ended.value.code or 0), said.out, said.err

    return call


def known(data_dir: Path) -> KnownPrincipals:
    return KnownPrincipals(data_dir / "principals.yaml", datetime.now(UTC).timestamp)


def test_the_token_that_add_prints_is_the_principals(mend: Mend, data_dir: Path) -> None:
    code, token, warning = mend("add", "anna", "--role", "helper", "--expires", "30")
    assert code == 0
    assert "nobody is an admin yet" in warning
    found = known(data_dir).of_token(token.strip())
    assert found is not None
    assert (found.name, found.role) == ("anna", Role.HELPER)
    assert mend("add", "ada", "--role", "admin")[2] == ""
    rows = [row.split("\t") for row in mend("list")[1].splitlines()]
    assert [row[:2] for row in rows] == [["anna", "helper"], ["ada", "admin"]]


def test_rotate_prints_another_token_and_revoke_ends_both(mend: Mend, data_dir: Path) -> None:
    _, old, _ = mend("add", "anna", "--role", "helper")
    code, new, _ = mend("rotate", "anna")
    assert code == 0
    assert known(data_dir).of_token(old.strip()) is None
    assert known(data_dir).of_token(new.strip()) is not None
    assert mend("revoke", "anna")[0] == 0
    assert known(data_dir).of_token(new.strip()) is None
    assert mend("revoke", "anna") == (
        2, "", "mend: there is no principal 'anna' (there are: none)\n",
    )  # fmt: skip


def test_enrol_prints_a_code(mend: Mend) -> None:
    code, printed, _ = mend("enrol", "arm-1")
    assert code == 0
    assert [len(each) for each in printed.strip().split("-")] == [4] * 6


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["add", "token", "--role", "admin"], "nobody can be called 'token'"),
        (["enrol", "a\tb"], "characters that can be seen"),
        (["rotate", "anna"], "there is no principal 'anna'"),
    ],
)
def test_a_refusal_is_a_sentence(mend: Mend, arguments: list[str], sentence: str) -> None:
    code, out, err = mend(*arguments)
    assert (code, out) == (2, "")
    assert sentence in err


def test_a_file_with_mistakes_is_told_in_sentences(mend: Mend, data_dir: Path) -> None:
    data_dir.mkdir()
    file = data_dir / "principals.yaml"
    file.write_text("principals: [{name: anna, role: boss}]")
    code, _, err = mend("list")
    assert code == 2
    assert f"mend: {file}: principals.0.role: must be" in err
    assert f"mend: {file}: principals.0.id: is missing." in err


async def test_audit_lists_deeds_and_exports_them_as_json_lines(mend: Mend, data_dir: Path) -> None:
    olga = ev.Author(principal="olga", role=Role.OPERATOR, address="10.0.0.7")
    now, run = datetime(2026, 5, 4, 12, tzinfo=UTC), uuid4()
    journal = SqliteJournal(data_dir / "journal.db")
    await journal.append(
        Entry(
            events=[
                ev.DocumentDeleted(wall_time=now, kind="tree", name="old", author=olga),
                ev.RunPaused(time=1.0, wall_time=now, run=run, author=olga),
                ev.SignInFailed(wall_time=now, times=3, addresses=[]),
            ]
        )
    )
    code, listed, _ = mend("audit")
    assert code == 0
    assert listed.splitlines() == [
        "2026-05-04 12:00:00\tolga\toperator\t10.0.0.7\tdeleted the tree 'old'",
        "2026-05-04 12:00:00\tolga\toperator\t10.0.0.7\tpaused the run",
        "2026-05-04 12:00:00\t\t\t\tshowed wrong tokens 3 times",
    ]
    _, exported, _ = mend("audit", "--json", "--who", "olga")
    lines = [json.loads(line) for line in exported.splitlines()]
    assert [(each["deed"], each["run"]) for each in lines] == [
        ("document_deleted", None),
        ("run_paused", str(run)),
    ]
    journal.close()


def test_a_table_shows_what_is_not_printed_spelt_out(capsys: pytest.CaptureFixture[str]) -> None:
    print_rows([("a\u202egnp", "x\x9b31m")], ("name", "role"))
    assert capsys.readouterr().out == "a\\u202egnp\tx\\x9b31m\n"
