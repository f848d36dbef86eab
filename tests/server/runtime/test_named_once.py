"""Whatever comes next is named once, by its place where its name does not tell it apart."""

from typing import Any

import pytest
from pretend_service import pretend_service
from task_documents import definition_of

from mend.server.journal import events as ev
from mend.sim.tabletop.layout import lay_out

NAMES = [("tape", "tray"), ("stapler", "mat"), ("lamp", "shelf"), ("pen", "cup")]
SCENE = lay_out(NAMES, seed=1)


def leaf(part: str, place: str, name: str) -> dict[str, str]:
    return {"behavior": "pick_and_place", "object": part, "place": place, "name": name}


FAILS = leaf("pen", "cup", "pen")
STAPLER = leaf("stapler", "mat", "stapler")


async def last_word(tree: Any, **options: Any) -> str:
    """What is said last of a pen that is not picked up, and nobody helps with."""
    faults = {"pen": [("missed", 4)] * 9}
    async with pretend_service(definition_of(tree), faults, scene=SCENE, wrong=True) as service:
        _, events = await service.run_to_end(answers="none", **options)
    said = [each.text for each in events if isinstance(each, ev.Prompt) and each.kind == "say"]
    return said[0]


@pytest.mark.parametrize(
    ("alternatives", "words"),
    [
        ([leaf("tape", "tray", "one"), STAPLER], "the tape or the stapler"),
        (
            [leaf("tape", "tray", "one"), leaf("tape", "shelf", "other"), STAPLER],
            "the tape for the tray, the tape for the shelf or the stapler",
        ),
        (
            [
                {"then": [leaf("tape", "tray", "one"), leaf("lamp", "shelf", "lamp")]},
                {"then": [leaf("tape", "tray", "other"), leaf("lamp", "cup", "lamp_2")]},
                STAPLER,
            ],
            "the tape or the stapler",
        ),
        ([leaf("pen", "mat", "pen_2"), STAPLER], "the pen for the mat or the stapler"),
    ],
)
async def test_every_alternative_is_named_once(alternatives: list[Any], words: str) -> None:
    said = await last_word({"or": [FAILS, *alternatives]}, max_attempts=1)
    assert said == f"I heard no answer. I take {words} instead."


async def test_what_goes_first_is_named_once() -> None:
    tree = {"and": [FAILS, {"or": [leaf("tape", "tray", "one"), leaf("tape", "mat", "two")]}]}
    assert await last_word(tree) == (
        "I heard no answer. I go on with the tape for the tray or the tape for the mat first, "
        "then I try again (attempt 2 of 3)."
    )
