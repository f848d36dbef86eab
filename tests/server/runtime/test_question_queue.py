"""The queue of open questions: the most urgent first, those alike together, and what is safe."""

from datetime import UTC, datetime, timedelta
from uuid import UUID, uuid4

from mend.server.journal.events import WayOption
from mend.server.runtime.question_queue import OpenQuestion, batches_of, ways_for_all
from mend.server.runtime.views import QuestionView

NOON = datetime(2026, 1, 1, 12, tzinfo=UTC)
SITE = uuid4()


def way(name: str, *answers: str) -> WayOption:
    said = ["yes" if each == "yes" else "no" for each in answers]
    return WayOption.model_validate(
        {"way": name, "deed": name, "label": name.title(), "effect": "", "answers": said}
    )


LOST_PART = [way("put_back", "yes"), way("place", "no", "yes"), way("later", "no", "no")]
AT_A_DOOR = [way("clear_way", "yes"), way("later", "no")]


def question(
    number: int,
    *,
    left_s: float | None = 30.0,
    issue: str = "dropped",
    ways: list[WayOption] = LOST_PART,
    headline: str = "Put the cup back",
    barred: tuple[UUID, frozenset[str]] | None = None,
) -> OpenQuestion:
    view = QuestionView(
        dialogue=uuid4(),
        prompt=uuid4(),
        run=uuid4(),
        tree="tea",
        robot=f"robot{number}",
        name="cup",
        object="cup",
        place="tray",
        headline=headline,
        left_s=left_s,
        opened=NOON + timedelta(seconds=number),
        attempt=1,
        attempts=3,
        to=None,
        claimed_by=None,
    )
    return OpenQuestion(view, issue, ways, number, barred)


def robots(questions: list[OpenQuestion]) -> list[list[str]]:
    return [[each.robot for each in batch.questions] for batch in batches_of(questions)]


def test_what_expires_first_stands_first_and_then_what_was_asked_first() -> None:
    alone = [[way(f"way {number}", "yes"), way("later", "no")] for number in range(5)]
    asked = [
        question(3, left_s=20.0, ways=alone[0]),
        question(2, left_s=None, ways=alone[1]),
        question(4, left_s=10.0, ways=alone[2]),
        question(1, left_s=20.0, ways=alone[3]),
        question(0, left_s=None, ways=alone[4]),
    ]
    assert robots(asked) == [["robot4"], ["robot1"], ["robot3"], ["robot0"], ["robot2"]]


def test_the_same_question_of_several_robots_is_one_entry_where_its_most_urgent_stands() -> None:
    asked = [
        question(1, left_s=40.0),
        question(2, left_s=20.0, issue="door_closed", ways=AT_A_DOOR),
        question(3, left_s=10.0),
    ]
    assert robots(asked) == [["robot3", "robot1"], ["robot2"]]


def test_questions_with_other_ways_are_not_the_same() -> None:
    refused = LOST_PART[1:]
    assert robots([question(1), question(2, ways=refused)]) == [["robot1"], ["robot2"]]


def test_questions_without_ways_stand_alone() -> None:
    assert robots([question(1, ways=[]), question(2, ways=[])]) == [["robot1"], ["robot2"]]


def test_what_is_asked_in_all_of_them_stands_over_them_without_the_names() -> None:
    same, other = question(1), question(2, headline="Put the saucer back")
    assert batches_of([same])[0].headline == "Put the cup back"
    assert batches_of([same, other])[0].headline == "Put_Back"


def at_once(*questions: OpenQuestion) -> list[str]:
    return [each.way for each in ways_for_all(questions)]


def test_to_refuse_is_safe_for_all_and_to_promise_is_not() -> None:
    assert at_once(question(1), question(2)) == ["later"]


def test_a_single_question_is_answered_on_its_own() -> None:
    assert at_once(question(1)) == []


def test_one_door_is_opened_for_all_who_stand_at_it_from_either_side() -> None:
    door = (SITE, frozenset({"hall", "F1_101"}))
    both = [question(number, issue="door_closed", ways=AT_A_DOOR, barred=door) for number in (1, 2)]
    assert at_once(*both) == ["clear_way", "later"]


def test_other_doors_and_those_of_other_sites_are_opened_each_on_its_own() -> None:
    doors = [
        (SITE, frozenset({"hall", "F1_101"})),
        (SITE, frozenset({"hall", "F1_102"})),
        (uuid4(), frozenset({"hall", "F1_101"})),
        None,
    ]
    asked = [question(1, issue="door_closed", ways=AT_A_DOOR, barred=each) for each in doors]
    for number, one in enumerate(asked):
        for other in asked[number + 1 :]:
            assert at_once(one, other) == ["later"]


def test_what_is_not_alike_is_answered_each_on_its_own() -> None:
    assert at_once(question(1), question(2, issue="door_closed", ways=AT_A_DOOR)) == []
