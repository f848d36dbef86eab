"""Reads a log of any known format: bags by their names, others by what their lines begin with."""

from collections.abc import Callable
from pathlib import Path

from mend.errors import WrongInputError
from mend.localization.bags.bag import is_bag
from mend.localization.bags.choice import BagChoice
from mend.localization.bags.reading import read_bag
from mend.localization.logs.carmen import read_carmen
from mend.localization.logs.csv_log import read_csv
from mend.localization.logs.log import Log, RecordedDrive
from mend.localization.logs.text_lines import numbered_lines
from mend.localization.logs.wean import read_wean

FORMATS: dict[str, Callable[[Path], Log]] = {
    "carmen": read_carmen,
    "wean": read_wean,
    "csv": read_csv,
}
_LINES_LOOKED_AT = 1000
_CARMEN = ("FLASER", "RLASER", "ROBOTLASER1", "ODOM", "PARAM", "NEFF", "SYNC", "TRUEPOS")


def read_drive(path: Path, choice: BagChoice | None = None) -> RecordedDrive:
    """The drive of a bag, as `choice` has it, or of a log. Raises `WrongInputError`, `OSError`."""
    return read_bag(path, choice) if is_bag(path) else read_log(path)


def read_log(path: Path) -> Log:
    """The log of a file. Raises `WrongInputError`, or `OSError`."""
    return FORMATS[_format_of(path)](path)


def _format_of(path: Path) -> str:
    for number, line in numbered_lines(path):
        first = line.split(maxsplit=1)[0] if line else ""
        if first in _CARMEN:
            return "carmen"
        if first in ("L", "O") and len(line.split()) > 4:
            return "wean"
        if line.lstrip("\ufeff").startswith(("time_s,", '"time_s"')):
            return "csv"
        if number >= _LINES_LOOKED_AT:
            break
    raise WrongInputError(
        f"{path}: neither a CARMEN log (FLASER, ODOM lines), nor a Wean Hall log (L, O lines), "
        "nor CSV whose first column is time_s, nor a ROS bag (.bag, .db3, .mcap, or a folder)"
    )
