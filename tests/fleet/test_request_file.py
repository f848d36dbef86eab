"""Request files: every mistake with its line, and nothing else."""

import pytest

from mend.fleet.request_file import RequestFileError, read_request_text
from mend.fleet.requests import DeliverMessage, Transport

GOOD = """
requests:
  - {kind: transport, name: parcel, what: the parcel, origin: F1/101, destination: F2/203}
  - {kind: deliver_message, name: lunch, place: F1/102, message: Lunch is ready., latest_s: 900}
"""


def test_requests_are_read_in_their_order() -> None:
    document = read_request_text(GOOD)
    assert [type(each) for each in document.requests] == [Transport, DeliverMessage]
    assert [each.latest_s for each in document.requests] == [None, 900.0]


@pytest.mark.parametrize(
    ("text", "line", "sentence"),
    [
        ("[]", 1, "a request file is a mapping with 'requests', but this is a list"),
        (GOOD.replace("name: lunch", "name: parcel"), 4, "two requests are called 'parcel'"),
        (GOOD.replace("kind: transport", "kind: fly"), 3, "'fly'"),
        (GOOD.replace("what: the parcel, ", ""), 3, "'requests.0.transport.what' is missing"),
        ("requests: []", 1, "'requests'"),
        ("requests: [", 2, "not valid YAML or JSON"),
    ],
)
def test_a_mistake_is_told_with_its_line(text: str, line: int, sentence: str) -> None:
    with pytest.raises(RequestFileError) as refused:
        read_request_text(text)
    (problem,) = refused.value.problems
    assert problem.line == line
    assert sentence in problem.message
