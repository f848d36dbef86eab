"""Every view that the console is tested in is shown in the documentation."""

from pathlib import Path

from console_situations import SITUATIONS

DOCS = Path(__file__).parents[2] / "docs"


def test_each_view_has_its_sheet_and_each_sheet_its_view() -> None:
    sheets = {each.stem for each in (DOCS / "images" / "views").glob("*.webp")}
    assert sheets == SITUATIONS.keys()


def test_the_page_shows_all_of_them() -> None:
    shown = (DOCS / "views.md").read_text("utf-8")
    assert [each for each in SITUATIONS if f"](images/views/{each}.webp)" not in shown] == []
