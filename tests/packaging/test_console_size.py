"""What a helper's browser has to fetch before a question can be answered."""

import gzip
import re
from pathlib import Path

import pytest

from mend.server.api.console import BUILT

MAX_BYTES = 45 * 1024
MAX_BYTES_OF_WORDS = 20 * 1024
WORDS = ("answering", "sentences", "clauses", "notices")
"""What a helper reads while answering, in a language other than English."""

# Bare, as in `import"./x.js"` and `from"./x.js"`: what is imported when it is needed has a bracket.
STATIC_IMPORT = re.compile(rb"""(?:\bfrom|\bimport)\s*["']\./([\w.-]+\.js)["']""")
# The page itself, which comes once its words have: its script, and the style that goes with it.
BEGUN = re.compile(rb"""["'`](?:\./|assets/)(begin-[\w.-]+\.(?:js|css))["'`]""")
ENTRY = re.compile(rb"""(?:src|href)="/(assets/[\w.-]+\.(?:js|css))\"""")


def answering_path(built: Path) -> set[Path]:
    """The page, what it names, and all that these import before a question can be answered."""
    page = built / "index.html"
    found = {page}
    waiting = [built / name.decode() for name in ENTRY.findall(page.read_bytes())]
    while waiting:
        file = waiting.pop()
        if file in found:
            continue
        found.add(file)
        if file.suffix == ".js":
            names = [*STATIC_IMPORT.findall(file.read_bytes()), *BEGUN.findall(file.read_bytes())]
            waiting += [built / "assets" / name.decode() for name in names]
    return found


def test_static_imports_are_followed_and_lazy_ones_are_not(tmp_path: Path) -> None:
    assets = tmp_path / "assets"
    assets.mkdir()
    page = '<script src="/assets/a.js"></script><link href="/assets/a.css" rel="stylesheet">'
    (tmp_path / "index.html").write_text(page)
    (assets / "a.js").write_text('import{b}from"./b.js";import"./c.js";b(()=>import("./later.js"))')
    (assets / "b.js").write_text('export*from"./c.js"')
    (assets / "c.js").write_text("")
    names = {path.name for path in answering_path(tmp_path)}
    assert names == {"index.html", "a.js", "a.css", "b.js", "c.js"}


@pytest.mark.skipif(
    not (BUILT / "index.html").is_file(), reason="the console is not built (make console)"
)
def test_answering_path_is_at_most_45_kib() -> None:
    sizes = {path.name: len(gzip.compress(path.read_bytes(), 9)) for path in answering_path(BUILT)}
    assert {Path(name).suffix for name in sizes} == {".html", ".js", ".css"}
    assert sum(sizes.values()) <= MAX_BYTES, sizes


@pytest.mark.skipif(
    not (BUILT / "index.html").is_file(), reason="the console is not built (make console)"
)
def test_another_language_comes_by_itself_and_is_at_most_20_kib_more() -> None:
    files = {name: [*(BUILT / "assets").glob(f"{name}-*.js")] for name in WORDS}
    assert all(files.values())
    assert not answering_path(BUILT) & {path for each in files.values() for path in each}
    # Each language has one of every name: no page loads more than the largest.
    sizes = {
        name: max(len(gzip.compress(path.read_bytes(), 9)) for path in of_languages)
        for name, of_languages in files.items()
    }
    assert sum(sizes.values()) <= MAX_BYTES_OF_WORDS, sizes
