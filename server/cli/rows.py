"""A table on stdout."""

import sys

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from mend.server.plain_text import plain


def print_rows(rows: list[tuple[str, ...]], headings: tuple[str, ...]) -> None:
    """Print a table: with headings in a terminal, tab-separated lines where stdout is piped."""
    console = Console(highlight=False)
    rows = [tuple(plain(each) for each in row) for row in rows]
    if not console.is_terminal:
        for row in rows:
            sys.stdout.write("\t".join(row) + "\n")
        return
    table = Table(*headings, box=SIMPLE_HEAD, pad_edge=False)
    for row in rows:
        table.add_row(*(Text(each) for each in row))
    console.print(table)
