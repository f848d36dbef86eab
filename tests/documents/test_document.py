"""Documents: values with their lines, within limits."""

import pytest

from mend.documents.document import MAX_DEPTH, DocumentError, LinedMapping, read_document


def test_values_know_their_lines() -> None:
    document, problems = read_document("a: 1\nb:\n  - x\n  - {c: 2}\n")
    assert problems == []
    assert document == {"a": 1, "b": ["x", {"c": 2}]}
    assert document.key_lines == {"a": 1, "b": 2}
    assert document["b"].item_lines == [3, 4]


def test_plain_values_are_those_of_yaml_1_2() -> None:
    text = "[yes, no, on, true, False, null, ~, 12, -3, 1e3, 0x1F, 1.5, .5, 2026-01-02, '7', nan]"
    assert read_document(text)[0] == [
        "yes", "no", "on", True, False, None, None, 12, -3, 1000.0, "0x1F", 1.5, 0.5,
        "2026-01-02", "7", "nan",
    ]  # fmt: skip


def test_a_key_given_twice_is_a_problem_and_the_first_counts() -> None:
    document, (problem,) = read_document("a: 1\nb: 2\na: 3\n")
    assert document == {"a": 1, "b": 2}
    assert (problem.line, problem.message) == (3, "the key 'a' is given twice, first in line 1")


def test_an_alias_repeats_its_anchor() -> None:
    document, _ = read_document("a: &x {k: 1}\nb: *x\n")
    assert isinstance(document, LinedMapping)
    assert document["b"] == {"k": 1}


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("a: 1\nb: *x", 2, "names no anchor|undefined alias"),
        ("&x [*x]", 1, "stands inside what it repeats"),
        ("a: 1\n? [b]\n: 2", 2, "a key must be text"),
        ("a: !!python/object:os.system x", 1, "the tag '.*' is not allowed"),
        ("a: !!set {b}", 1, "is not allowed"),
        ("a: 1\n---\nb: 2", 2, "more than one document"),
        ("[" * (MAX_DEPTH + 1), 1, f"deeper than {MAX_DEPTH} levels"),
        ("a: 1\nb: }", 2, "not valid YAML or JSON"),
    ],
)
def test_what_cannot_be_read_is_told_with_its_line(text: str, line: int, message: str) -> None:
    with pytest.raises(DocumentError, match=message) as caught:
        read_document(text)
    assert caught.value.problem.line == line


def test_aliases_of_aliases_do_not_multiply_without_end() -> None:
    lines = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    for i in range(1, 12):
        lines.append(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]")
    with pytest.raises(DocumentError, match="more than 4000000 values"):
        read_document("\n".join(lines))
