"""What a spreadsheet makes of names that people give."""

import csv
import io

import pytest
from sample_events import detected

from mend.server.export.csv_file import CsvFile
from mend.server.report.csv_text import no_formula
from mend.server.report.table import written
from mend.server.transcript_line import Line, Tone

FORMULA = '=HYPERLINK("http://example.org")'


@pytest.mark.parametrize("text", [FORMULA, "+1", "-ann", "@ann", "\tann", "\rann"])
def test_what_looks_like_a_formula_is_written_as_text(text: str) -> None:
    assert no_formula(text) == written(text) == f"'{text}"


@pytest.mark.parametrize("text", ["", "ann", "a=b", "'=1", "1 - 2"])
def test_any_other_text_stays_as_it_is(text: str) -> None:
    assert no_formula(text) == written(text) == text


def test_figures_stay_figures() -> None:
    assert [written(-1.5), written(-2), written(None)] == ["-1.5", "-2", ""]


def test_an_exported_run_has_no_formula_in_any_cell() -> None:
    file = CsvFile()
    told = [Line(time_s=1.0, speaker="", text=FORMULA, tone=Tone.FAULT)]
    file.add_event(detected().model_copy(update={"object": FORMULA}), "", told)
    [row] = csv.DictReader(io.StringIO(file.end().decode(), newline=""))
    assert row["object"] == row["told"] == f"'{FORMULA}"
