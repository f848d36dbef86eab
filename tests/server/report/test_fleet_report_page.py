"""The page of a fleet's report needs nothing but itself, and shows what was found and failed."""

import csv
import re
from pathlib import Path

from fleet_events import FLEET, SITE, LegMaker, asked
from test_fleet_history import day

from mend.fleet.requests import LegAction
from mend.server.journal import events as ev
from mend.server.report.fleet_history import FleetHistory
from mend.server.report.fleet_page import tables_of, write_fleet_csv, write_fleet_report
from mend.server.report.span import Span


def trouble() -> list[ev.Event]:
    """A leg that fails, a way that is found shut, and a robot that is taken out of service."""
    visit = LegMaker("r0", 3, "<b>tea</b>", LegAction.VISIT)
    found = ev.FleetTold(at_s=150.0, told="found of the way: blocked", finder="r0", **FLEET)
    out = ev.FleetTold(at_s=180.0, told="took r0 out", robot="r0", in_service=False, **FLEET)
    return [visit.begun(140.0), found, visit.ended(170.0, outcome="failed"), out]


def page(tmp_path: Path, events: list[ev.Event]) -> str:
    history = FleetHistory.of(SITE, events, Span())
    write_fleet_report(tmp_path / "report.html", history, tables_of(history))
    return (tmp_path / "report.html").read_text(encoding="utf-8")


def test_it_refers_to_nothing_outside(tmp_path: Path) -> None:
    text = page(tmp_path, [*day(), *trouble()])
    assert not re.findall(r"(?:src|href)=|url\(|@import|<script", text)
    assert set(re.findall(r"https?://[^\s\"<]+", text)) == {"http://www.w3.org/2000/svg"}


def test_it_marks_what_failed_and_was_found_and_says_so(tmp_path: Path) -> None:
    text = page(tmp_path, [*day(), *trouble()])
    for class_ in ("failed", "found", "out"):
        assert re.search(rf'<path [^>]*class="{class_}"><title>', text)
    assert (
        "5 legs of 2 robots in 3.0 min, of which 1 ended without being done; 1 finding of" in text
    )
    assert "<b>tea" not in text


def test_it_tells_first_what_there_is_to_know_first(tmp_path: Path) -> None:
    figures = re.findall(r"<li><strong>([^<]*)</strong><span>([^<]*)<", page(tmp_path, day()))
    assert figures == [
        ("1 of 2", "requests done"),
        ("4", "legs ended"),
        ("100 m", "driven, in the 3 of 4 legs with known metres"),
        ("2", "interventions, in the 3 of 4 legs with known metres"),
        ("50 m", "between interventions, in the 3 of 4 legs with known metres"),
        ("1.5 min", "saved by transfers, as planned"),
    ]


def test_every_chart_has_words_for_those_who_do_not_see_it(tmp_path: Path) -> None:
    text = page(tmp_path, day())
    charts = re.findall(
        r'<svg xmlns[^>]*role="img" aria-label="[^"]+">\s*<title>[^<]+</title>', text
    )
    assert len(charts) == text.count('aria-label="Chart: ') == 5


def test_a_time_without_requests_has_a_page_without_charts(tmp_path: Path) -> None:
    text = page(tmp_path, trouble()[-1:])
    assert "Chart:" not in text


def test_every_table_and_the_timeline_are_written_as_csv(tmp_path: Path) -> None:
    history = FleetHistory.of(SITE, day(), Span())
    tables = tables_of(history)
    write_fleet_csv(tmp_path, history, tables)
    assert {each.stem for each in tmp_path.glob("*.csv")} == {
        *(each.name for each in tables),
        "stretches",
    }
    with (tmp_path / "legs.csv").open(encoding="utf-8", newline="") as file:
        legs = list(csv.DictReader(file))
    assert [each["driven, m"] for each in legs] == ["30", "50", "", "20"]


def test_figures_of_some_legs_are_not_told_as_those_of_all(tmp_path: Path) -> None:
    collect, bring = (
        LegMaker("r0", number, "mail", action)
        for number, action in enumerate((LegAction.COLLECT, LegAction.HAND_OVER), 1)
    )
    helped = bring.run()
    events = [
        asked("mail", "booked", 0.0),
        collect.begun(0.0),
        collect.ended(10.0, driven_m=14.0),
        bring.begun(10.0),
        helped.started(),
        *helped.dialogue(2.0, 4.0, "lost", 1),
        bring.ended(30.0),
        asked("mail", "done", 30.0),
    ]
    text = page(tmp_path, events)
    figures = re.findall(r"<li><strong>([^<]*)</strong><span>([^<]*)<", text)
    assert figures[2:] == [
        ("14 m", "driven, in the 1 of 2 legs with known metres"),
        ("0", "interventions, in the 1 of 2 legs with known metres"),
    ]
    history = FleetHistory.of(SITE, events, Span())
    (requests,) = [each for each in tables_of(history) if each.name == "each_request"]
    assert [
        dict(zip(requests.columns, row, strict=True))["driven, m"] for row in requests.rows
    ] == [None]
