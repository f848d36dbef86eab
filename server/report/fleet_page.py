"""The report of a building's fleet as one HTML file, or as CSV, a file for each table."""

import csv
from collections.abc import Sequence
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined

from mend.server.report.fleet_tally import Table


def write_fleet_report(path: Path, site: str, tables: Sequence[Table]) -> None:
    """Write the page. Raises `OSError`."""
    environment = Environment(
        loader=PackageLoader("mend.server.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    text = environment.get_template("fleet.html").render(site=site, tables=tables)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def write_fleet_csv(folder: Path, tables: Sequence[Table]) -> None:
    """Write each table as `NAME.csv`. Raises `OSError`."""
    folder.mkdir(parents=True, exist_ok=True)
    for table in tables:
        with (folder / f"{table.name}.csv").open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(table.columns)
            writer.writerows(table.rows)
