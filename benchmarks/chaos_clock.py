"""`mend serve` with a wall clock that jumps when it is told to: a program of its own.

    python benchmarks/chaos_clock.py FILE

Every clock of the service that tells the date is shifted by the seconds that the file holds, but
for that of the note that a journal's format was changed. The kernel's own clock is left alone, as
everything on the machine shares it.
"""

import os
import sys
import time
from datetime import datetime, timedelta, tzinfo
from pathlib import Path
from typing import Any


class Offset:
    """How far the clock is off, in seconds, as the file says now."""

    def __init__(self, file: Path) -> None:
        # Kept open: there may be no descriptor left when it is to be read.
        self._file = file.open("rb")
        self._changed_ns = 0
        self._s = 0.0

    def __call__(self) -> float:
        changed_ns = os.fstat(self._file.fileno()).st_mtime_ns
        if changed_ns != self._changed_ns:
            self._changed_ns = changed_ns
            self._s = float(os.pread(self._file.fileno(), 100, 0) or 0.0)
        return self._s


def main(file: Path) -> None:
    offset, true_time_s = Offset(file), time.time

    class Shifted(datetime):
        @classmethod
        def now(cls, tz: tzinfo | None = None) -> Any:
            return datetime.now(tz) + timedelta(seconds=offset())

    # Before anything of the service is imported, which takes the function as it is then.
    time.time = lambda: true_time_s() + offset()
    import mend.server.composition as composition
    from mend.server.cli import main as mend

    composition.datetime = Shifted  # type: ignore[misc]
    sys.argv = ["mend", "serve"]
    mend()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
