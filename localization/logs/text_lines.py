"""The lines of a log's file, compressed or not."""

import gzip
import zlib
from collections.abc import Iterator
from pathlib import Path

from mend.errors import WrongInputError

_GZIP = b"\x1f\x8b"


def numbered_lines(path: Path) -> Iterator[tuple[int, str]]:
    """Lines counted from 1, without their ends. Raises `WrongInputError`, or `OSError`."""
    with path.open("rb") as file:
        compressed = file.read(2) == _GZIP
    with (
        gzip.open(path, "rt", errors="replace")
        if compressed
        else path.open(errors="replace") as lines
    ):
        try:
            for number, line in enumerate(lines, start=1):
                yield number, line.strip()
        except (EOFError, zlib.error, gzip.BadGzipFile) as error:
            raise WrongInputError(f"{path}: the compressed file is damaged: {error}") from error
