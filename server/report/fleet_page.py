"""The report of a building's fleet as one HTML file, or as CSV, a file for each table."""

import csv
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from mend.server.report.fleet_charts import charts_of, requests_by_time
from mend.server.report.fleet_history import FleetHistory
from mend.server.report.fleet_plans import plan_changes, saved_s, transfers
from mend.server.report.fleet_requests import (
    each_request,
    outcome_of,
    requests_by_kind,
    waits_by_kind,
)
from mend.server.report.fleet_robots import (
    interventions_in,
    legs_by_robot,
    metres_between,
    metres_by_robot,
    questions_by_issue,
)
from mend.server.report.fleet_times import each_leg, each_stretch, times_by_kind, times_by_robot
from mend.server.report.leg_times import metres_of
from mend.server.report.table import Table, shown, written


def tables_of(history: FleetHistory) -> list[Table]:
    """All tables, in their order on the page."""
    return [
        requests_by_kind(history),
        requests_by_time(history),
        waits_by_kind(history),
        times_by_kind(history),
        times_by_robot(history),
        each_leg(history),
        legs_by_robot(history),
        metres_by_robot(history),
        questions_by_issue(history),
        transfers(history),
        plan_changes(history),
        each_request(history),
    ]


def write_fleet_report(path: Path, history: FleetHistory, tables: Sequence[Table]) -> None:
    """Write the page. Raises `OSError`."""
    environment = Environment(
        loader=PackageLoader("mend.server.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["shown"] = shown
    text = environment.get_template("fleet.html").render(
        site=str(history.site),
        facts=_facts(history),
        figures=_figures(history),
        tables=tables,
        charts={name: (Markup(each.svg), each.legend) for name, each in charts_of(history).items()},
        version=version("mend-robots"),
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def _facts(history: FleetHistory) -> list[tuple[str, str]]:
    times = [each.wall_time for each in history.within]
    return [
        ("Site", str(history.site)),
        ("Clock of the site", f"{history.begins_s:.0f} s to {history.ends_s:.0f} s"),
        ("From", f"{times[0]:%Y-%m-%d %H:%M:%S} UTC"),
        ("Until", f"{times[-1]:%Y-%m-%d %H:%M:%S} UTC"),
    ]


def _figures(history: FleetHistory) -> list[tuple[str, str]]:
    """What there is to know first, as far as it is known."""
    asked, legs = history.asked, [leg for leg, _ in history.ended]
    done = sum(outcome_of(each) == "done" for each in asked)
    figures = [(f"{done} of {len(asked)}", "requests done"), (str(len(legs)), "legs ended")]
    driven_m, helped = metres_of(legs), interventions_in(legs)
    known = sum(metres_of([each]) is not None for each in legs)
    # Of the other legs nobody knows how far it was, so their interventions do not count either.
    of_known = (
        "" if known == len(legs) else f", in the {known} of {len(legs)} legs with known metres"
    )
    if driven_m is not None:
        figures.append((f"{driven_m:.0f} m", f"driven{of_known}"))
        figures.append((str(len(helped)), f"interventions{of_known}"))
    if (between_m := metres_between(legs, helped)) is not None:
        figures.append((f"{between_m:.0f} m", f"between interventions{of_known}"))
    if saved := saved_s(history):
        figures.append((f"{sum(saved) / 60:.1f} min", "saved by transfers, as planned"))
    return figures


def write_fleet_csv(folder: Path, history: FleetHistory, tables: Sequence[Table]) -> None:
    """Write each table, and what the timeline shows, as `NAME.csv`. Raises `OSError`."""
    folder.mkdir(parents=True, exist_ok=True)
    for table in (*tables, each_stretch(history)):
        with (folder / f"{table.name}.csv").open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(table.columns)
            writer.writerows([written(cell) for cell in row] for row in table.rows)
