"""What is no YAML is told in words of our own, with line and column."""

import pytest
from languages_of_console import untold

from mend.documents.document import DocumentError, read_document
from mend.documents.parser_mistakes import SENTENCES, UNKNOWN, parser_mistake

FILES = ("clauses", "refusals")


@pytest.mark.parametrize(
    ("text", "line", "column", "told"),
    [
        ("a: [1, 2\nb: 3", 2, 2, "',' or ']' is missing here (the list begins in line 1)"),
        ("{a: 1]", 1, 6, "',' or '}' is missing here"),
        ("a: b: c", 1, 5, "':' may not stand here"),
        (
            "a:\n  b: 1\n c: 2",
            3,
            2,
            "a key, indented like the others (the mapping begins",
        ),
        ("- a\nb: 1", 2, 1, "a '-', indented like the others (the list begins in line 1)"),
        ("a: 'b\nc", 2, 2, "a quotation mark is missing: the text ends before it (the text begins"),
        ("a: }", 1, 4, "a value is missing here"),
        ("a: @b", 1, 4, "put it between quotation marks"),
        ('a: "\\q"', 1, 5, "no such character may follow '\\'"),
        ("%FOO bar\n---\n", 1, 5, "what begins with '%' is a directive"),
        ("a: !<b", 1, 7, "what begins with '!' is a tag"),
        ("a: ü\nbü: \x07", 2, 5, "there is a character here that no text may have"),
        ("a:\n\tb: 1", 2, 1, "YAML is indented with spaces, and here is a tab"),
    ],
)
def test_the_mistake_is_told_with_line_and_column(
    text: str, line: int, column: int, told: str
) -> None:
    with pytest.raises(DocumentError) as refused:
        read_document(text)
    problem = refused.value.problem
    assert (problem.line, problem.column) == (line, column)
    assert told in problem.message


def test_what_the_parser_never_said_before_is_told_as_well() -> None:
    assert parser_mistake("did not find expected perfection") == UNKNOWN


def test_all_of_it_is_told_in_every_language() -> None:
    contexts = ("while parsing a flow sequence", "while parsing a block mapping", "in a dream")
    told = [
        f"the text is not valid YAML or JSON: {parser_mistake(problem, context, begun)}"
        for problem in (*SENTENCES, "did not find expected perfection")
        for context in (*contexts, "while scanning a quoted scalar")
        for begun in (None, 3)
    ]
    assert untold([*told, *(each.split(": ", 1)[1] for each in told)], FILES) == []
