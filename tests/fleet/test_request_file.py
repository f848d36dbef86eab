"""Request files: every mistake with its line, and nothing else."""

from pathlib import Path

import pytest

from mend.fleet.happenings import Cancelled, NobodyAnswers, RobotFails, WayBarred, WrongFloor
from mend.fleet.request_file import RequestFileError, read_request_file, read_request_text
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


HAPPENING = """
asked_s: {lunch: 60}
happenings:
  - {kind: way_barred, between: [F1/a, F1/b], at_s: 10, until_s: 20}
  - {kind: robot_fails, robot: r1, at_s: 5}
  - {kind: nobody_answers, at_s: 1, until_s: 2}
  - {kind: cancelled, request: parcel/2, at_s: 9}
  - {kind: wrong_floor, elevator: lift1, at_s: 3}
helpers: [reception]
transfer_places: [F1/lift1]
"""


def test_what_happens_meanwhile_is_read_with_when_requests_are_made() -> None:
    document = read_request_text(GOOD + HAPPENING)
    assert document.asked_s == {"lunch": 60.0}
    kinds = [type(each) for each in document.happenings]
    assert kinds == [WayBarred, RobotFails, NobodyAnswers, Cancelled, WrongFloor]
    assert (document.helpers, document.transfer_places) == (("reception",), ("F1/lift1",))
    assert document.happenings[0].between == ("F1/a", "F1/b")


@pytest.mark.parametrize("name", ["requests", "shift"])
def test_the_shipped_files_are_read(name: str) -> None:
    folder = Path(__file__).parents[2] / "examples" / "buildings"
    assert read_request_file(folder / f"{name}.yaml").requests


@pytest.mark.parametrize(
    ("text", "line", "sentence"),
    [
        (GOOD + HAPPENING.replace("{lunch: 60}", "{brunch: 60}"), 6, "is called 'brunch'"),
        (GOOD + HAPPENING.replace("parcel/2", "letter"), 11, "is called 'letter'"),
        (GOOD + HAPPENING.replace("until_s: 20", "until_s: 10"), 8, "is over after that"),
        (GOOD + HAPPENING.replace("way_barred", "flood"), 8, "'flood'"),
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
