"""Every claim of the threat model names tests that there are."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "SECURITY.md").read_text()
NAMED = re.findall(r"`(tests/[\w/]+\.py)::(test_\w+)`", PAGE)


def functions_in(file: str) -> set[str]:
    tree = ast.parse((ROOT / file).read_text())
    kinds = (ast.FunctionDef, ast.AsyncFunctionDef)
    return {each.name for each in tree.body if isinstance(each, kinds)}


@pytest.mark.parametrize(("file", "name"), sorted(set(NAMED)))
def test_a_test_that_is_named_is_there(file: str, name: str) -> None:
    assert name in functions_in(file)


def test_every_claim_names_a_test() -> None:
    claims = [
        line
        for section in PAGE.split("\n#")
        if "| test |" in section
        for line in section.splitlines()
        if line.startswith("| ") and "| test |" not in line
    ]
    assert len(claims) > 40
    assert [line for line in claims if not re.search(r"`tests/\S+::test_\w+`", line)] == []


def test_it_is_told_who_is_trusted_with_what() -> None:
    for who in ("host", "plug-ins", "admin", "operator", "helper", "viewer", "robot", "proxy"):
        assert re.search(rf"^\| .*{who}", PAGE, re.MULTILINE)
    # There is nobody behind an address that was made up.
    assert "@" not in PAGE
