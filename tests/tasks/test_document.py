"""Whatever a stranger sends is read, or refused in a sentence."""

import json
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tasks.document import DocumentError, read_document

YAML_LIKE = st.text(alphabet="ab01 \n:-?[]{},&*!|>'\"#%@`~<=._é\t", max_size=60)
PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(max_size=8),
    lambda inner: (
        st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=4), inner, max_size=4)
    ),
    max_leaves=12,
)


def problems_of(text: str) -> list[str]:
    try:
        read_document(text)
    except DocumentError as error:
        return error.problems
    return []


@given(text=YAML_LIKE | st.text(max_size=40))
@example(text="a: !!timestamp x")
@example(text="a: !!bool x")
@example(text="a: \ud800")
@example(text="a: " + "9" * 5000)
@example(text='a: "\\ud800"')
@example(text="<<: 1")
@settings(deadline=None, max_examples=300)
def test_any_text_is_read_or_refused_in_a_sentence(text: str) -> None:
    problems = problems_of(text)
    assert all(problems)


@given(data=st.dictionaries(st.text(max_size=4), PLAIN, max_size=4))
@settings(deadline=None)
def test_json_is_read_as_it_was_written(data: dict[str, Any]) -> None:
    assert read_document(json.dumps(data)).data == data


def test_half_a_surrogate_pair_is_refused() -> None:
    assert problems_of('a: 1\nb: "\\ud800"') == ["line 2: this has half of a surrogate pair"]


@pytest.mark.parametrize(
    ("location", "line"),
    [((), 1), (("tree",), 2), (("tree", 1), 3), (("tree", 1, "behavior"), 4), (("scene",), 1)],
)
def test_every_part_of_a_document_knows_its_line(
    location: tuple[int | str, ...], line: int
) -> None:
    text = "tree:\n  - behavior: a\n  - object: x\n    behavior: b\n"
    assert read_document(text).line_of(location) == line
