"""What docs/house.md says of where things are is so."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "house.md").read_text("utf-8")
FILES = sorted(set(re.findall(r"`((?:[a-z_]+/)+[a-z_]+\.py)`", PAGE)))


def test_the_page_says_where_twenty_things_or_more_are() -> None:
    table = PAGE.partition("## Where is it?")[2].partition("## ")[0]
    assert len(re.findall(r"^\| [A-Z].*\?", table, re.MULTILINE)) >= 20


@pytest.mark.parametrize("file", FILES)
def test_what_is_named_is_there(file: str) -> None:
    # Within a sentence about `robots/` a file of it may be named without that.
    assert any((ROOT / each / file).is_file() for each in ("", "robots", "server", "tasks"))
