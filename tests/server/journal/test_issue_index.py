"""The index of issues: each is found by what people know of it, and says how it ended."""

import sqlite3
from contextlib import closing
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from made_up_history import BEGUN, BETWEEN_RUNS, id_of, picture_id, run_id, write_history
from sample_events import detected, started

from mend.dialogue.script import CloseReason
from mend.server.journal import events as ev
from mend.server.journal.indexing import index_issues
from mend.server.journal.issue_index import IndexedIssue, IssuePage
from mend.server.journal.journal import Entry
from mend.server.journal.pruning import Keep
from mend.server.journal.sqlite import SqliteJournal

RUNS = 8
"""Each with one issue: its part 1 is dropped."""


@pytest.fixture(scope="module")
def history(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("history") / "journal.db"
    write_history(path, RUNS)
    return path


async def found(path: Path, **page: Any) -> list[int]:
    """The numbers of the runs whose issues are found."""
    journal = SqliteJournal(path)
    try:
        return [each.run.node for each in await journal.issues.page(IssuePage(**page))]
    finally:
        journal.close()


async def test_an_issue_is_told_with_all_that_leads_to_it(history: Path) -> None:
    journal = SqliteJournal(history)
    newest, *_ = await journal.issues.page(IssuePage())
    [raised] = [each for each in await journal.read(0, 1000, newest.run) if each.seq == newest.seq]
    journal.close()
    assert isinstance(raised, ev.IssueRaised)
    last = RUNS - 1
    assert newest == IndexedIssue(
        seq=raised.seq, run=run_id(last), issue="dropped", object="part_1", place="place_1",
        robot=f"pr2-{last:012x}", name="part_1", node="/1", step=5, time=15.0,
        raised=BEGUN + last * BETWEEN_RUNS, picture=picture_id(last), dialogue=id_of(1, last),
        outcome=CloseReason.RESOLVED, tree="made_up", world="tabletop",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("page", "runs"),
    [
        ({}, [7, 6, 5, 4, 3, 2, 1, 0]),
        ({"limit": 2}, [7, 6]),
        ({"text": "PART 1"}, [7, 6, 5, 4, 3, 2, 1, 0]),
        ({"text": " dropped "}, [7, 6, 5, 4, 3, 2, 1, 0]),
        ({"text": "made up"}, [7, 6, 5, 4, 3, 2, 1, 0]),
        ({"text": "0005"}, [5]),
        ({"text": "part_2"}, []),
        ({"text": "%"}, []),
        ({"issues": ["missing", "dropped"], "limit": 1}, [7]),
        ({"issues": ["missing"]}, []),
        ({"object": "part_1", "limit": 1}, [7]),
        ({"object": "part"}, []),
        ({"robot": f"pr2-{3:012x}"}, [3]),
        ({"tree": "eket"}, []),
        ({"outcomes": ["resolved"], "limit": 1}, [7]),
        ({"outcomes": ["gave_up"]}, []),
        ({"run": run_id(4)}, [4]),
        ({"since": BEGUN + 5 * BETWEEN_RUNS}, [7, 6, 5]),
        ({"until": BEGUN + 2 * BETWEEN_RUNS}, [1, 0]),
        ({"since": BEGUN + 2 * BETWEEN_RUNS, "until": BEGUN + 4 * BETWEEN_RUNS}, [3, 2]),
    ],
)
async def test_issues_are_found_by_what_people_know(
    history: Path, page: dict[str, Any], runs: list[int]
) -> None:
    assert await found(history, **page) == runs


async def test_pages_go_on_after_the_last_issue(history: Path) -> None:
    journal = SqliteJournal(history)
    pages, before = [], None
    while page := await journal.issues.page(IssuePage(before=before, limit=3)):
        pages.append([each.run.node for each in page])
        before = page[-1].seq
    journal.close()
    assert pages == [[7, 6, 5], [4, 3, 2], [1, 0]]


async def test_a_dialogue_belongs_to_its_own_robots_issue(tmp_path: Path) -> None:
    journal = SqliteJournal(tmp_path / "journal.db")
    run = started().run
    first = detected().model_copy(update={"robot": "anna"})
    second = detected().model_copy(update={"robot": "bert", "time": 2.0})
    about = {"run": run, "wall_time": first.wall_time, "node": "/0", "name": "green_leg"}
    about |= {"issue": "dropped", "object": "green_leg"}
    opened = ev.DialogueOpened(**about, time=3.0, dialogue=id_of(1, 1), robot="anna")
    closed = ev.DialogueClosed(
        **about, time=4.0, dialogue=id_of(1, 1), robot="anna", reason=CloseReason.GAVE_UP
    )
    await journal.append(Entry([started(), first, second, opened]))
    [of_bert, of_anna] = await journal.issues.page(IssuePage())
    assert (of_anna.dialogue, of_anna.outcome) == (id_of(1, 1), None)
    await journal.append(Entry([closed]))
    [of_bert, of_anna] = await journal.issues.page(IssuePage())
    journal.close()
    assert (of_bert.dialogue, of_bert.outcome) == (None, None)
    assert of_anna.outcome is CloseReason.GAVE_UP


async def test_issues_of_pruned_and_of_unreadable_runs_are_not_listed(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    write_history(path, RUNS)
    journal = SqliteJournal(path)
    await journal.mark_unreadable(run_id(6), "its events are damaged")
    await journal.prune(Keep(ended_runs=4), BEGUN + timedelta(days=1))
    assert [each.run.node for each in await journal.issues.page(IssuePage())] == [7, 5, 4]
    journal.close()


def rows(path: Path) -> list[Any]:
    with closing(sqlite3.connect(path)) as connection:
        return connection.execute("SELECT * FROM issues ORDER BY seq").fetchall()


def test_an_index_made_anew_from_the_events_is_the_same(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    write_history(path, RUNS)
    before = rows(path)
    assert len(before) == RUNS
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("DELETE FROM issues")
        index_issues(connection)
        connection.commit()
    assert rows(path) == before


@given(text=st.text(max_size=20))
async def test_any_text_may_be_searched_for(history: Path, text: str) -> None:
    numbers = await found(history, text=text, limit=1)
    names = f"dropped\npart_1\nplace_1\npr2-{RUNS - 1:012x}\npart_1\nmade_up".replace("_", " ")
    if text.strip().lower().replace("_", " ") in names:
        assert numbers == [RUNS - 1]
