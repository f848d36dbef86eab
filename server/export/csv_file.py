"""A run's events as CSV (RFC 4180), a row for each."""

import csv
import io
import json
from collections.abc import Sequence
from typing import Any

from mend.server.export.run_file import ShownPicture
from mend.server.journal import events as ev
from mend.server.poses.frame import Frame
from mend.server.report.csv_text import no_formula
from mend.server.transcript_line import Line

TIMES = ("seq", "time_s", "wall_time", "type")
NAMES = ("node", "name", "robot", "issue", "object", "place", "step", "dialogue", "helper")
COLUMNS = (*TIMES, *NAMES, "told", "more")
"""The columns, in order. New ones are only ever added at the end."""

LEFT_OUT = frozenset({"run", "tree", "scene", "script"})
"""Of a run's beginning what may be megabytes, and what would be the same in every row."""

_RENAMED = {"time": "time_s"}


class CsvFile:
    """What is common has a column; `told` is what the transcript tells, `more` all else as JSON."""

    shows = False

    def __init__(self) -> None:
        self._text = io.StringIO()
        self._writer = csv.writer(self._text)
        self._writer.writerow(COLUMNS)

    def add_event(self, event: ev.Event, text: str, lines: Sequence[Line]) -> None:  # noqa: ARG002
        fields = {
            _RENAMED.get(name, name): value
            for name, value in event.model_dump(mode="json", exclude=set(LEFT_OUT)).items()
        }
        told = "; ".join(f"{each.opening}{each.text}" for each in lines)
        known = {*TIMES, *NAMES}
        more = {name: value for name, value in fields.items() if name not in known}
        cells = [_cell(fields.get(name)) for name in (*TIMES, *NAMES)]
        self._writer.writerow(
            [*cells, no_formula(told), json.dumps(more, ensure_ascii=False) if more else ""]
        )

    def add_picture(self, shown: ShownPicture, jpeg: bytes) -> None:
        """There are none in it."""

    def add_frame(self, frame: Frame) -> None:
        """There are none in it."""

    def take(self) -> bytes:
        text = self._text.getvalue()
        self._text.seek(0)
        self._text.truncate()
        return text.encode()

    def end(self) -> bytes:
        return self.take()


def _cell(value: Any) -> str:
    if value is None:
        return ""
    return no_formula(value) if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
