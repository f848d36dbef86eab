"""What a transcript says of people, and of what robots wait for, is there in every language."""

from itertools import product
from typing import Any

import pytest
from languages_of_console import untold

from mend.dialogue.evidence import Change
from mend.dialogue.script import Help
from mend.server.journal import events as ev
from mend.server.runtime.unseen_help import SEEN_BY_HEAD
from mend.server.transcript import CHANGES, PROMISES, RESOLUTIONS, Transcript
from mend.server.transcript_words import DEEDS, deed_text
from mend.tasks.intervention import Act, Intervention
from mend.tasks.resolution import Resolution

ON_A_TABLE = (Help.PLACE, Help.PUT_BACK, Help.CLEAR_WAY, Help.CLEAR_VIEW)
FILES = ("clauses", "sentences")
PART = "green_leg"
NAMES: dict[str, Any] = {"between": ("F1/hall", "F1/kitchen"), "elevator": "lift1", "to": None}
OF: dict[str, Any] = {
    "time": 3.0,
    "wall_time": "2026-05-04T12:00:00Z",
    "run": "0b9f8a4e-5a52-4d5b-9a8e-3f1f7f0f5c11",
    "node": "/0",
    "name": PART,
    "robot": "pr2",
    "issue": "dropped",
    "object": PART,
    "dialogue": "c4e1b2a3-77aa-4b1e-9d2f-2a7f5b6c8d02",
}


def lines_of(event: ev.Event) -> list[str]:
    """As the console looks for them: with names as people say them."""
    return [each.text.replace("_", " ") for each in Transcript().lines(event)]


def made(kind: type[Any], **more: Any) -> Any:
    """An event of that kind, with what else is of no matter here."""
    return kind.model_validate({k: v for k, v in OF.items() if k in kind.model_fields} | more)


@pytest.mark.parametrize("act", DEEDS)
@pytest.mark.parametrize("about", [PART, None])
@pytest.mark.parametrize("manner", ["vanish", "pull"])
def test_every_deed_of_a_person_is(act: Act, about: str | None, manner: str) -> None:
    deed = Intervention.model_construct(act=act, object=about, place=None, manner=manner, **NAMES)
    told = deed_text(deed).replace("_", " ")
    assert untold([told, f"{told}: in vain, there is nothing in its basket"], FILES) == []


@pytest.mark.parametrize("reason", ["", "the glue is still wet"])
@pytest.mark.parametrize("kind", ev.SteeringEvent.__subclasses__())
def test_every_word_of_who_steers_is(kind: type[ev.SteeringEvent], reason: str) -> None:
    assert untold(lines_of(made(kind, by="ben", reason=reason)), FILES) == []


@pytest.mark.parametrize("level", ["off", "low", "high", "full"])
def test_every_level_of_autonomy_is(level: str) -> None:
    told = [
        made(ev.AutonomySet, by="ben", reason=reason, level=level) for reason in ("", "training")
    ]
    assert untold([line for each in told for line in lines_of(each)], FILES) == []


@pytest.mark.parametrize("helped", PROMISES)
def test_whatever_help_is_awaited_and_seen_is(helped: Help) -> None:
    # Only what happens on a table has a part that may have moved meanwhile.
    changes = [*CHANGES] if helped in ON_A_TABLE else [Change.NONE, Change.UNKNOWN]
    blind = [None, "my head camera measures no depth"] if helped in SEEN_BY_HEAD else [None]
    unseen = product((ev.HelpNotSeen, ev.HelpNotSeenYet), blind)
    told: list[ev.Event] = [
        made(ev.HelpAwaited, help=helped, helper="ann", until=33.0),
        *(made(ev.HelpVerified, help=helped, change=change) for change in changes),
        *(made(kind, help=helped, blind=why) for kind, why in unseen),
    ]
    assert untold([line for each in told for line in lines_of(each)], FILES) == []


@pytest.mark.parametrize("resolution", RESOLUTIONS)
def test_every_resolution_is(resolution: Resolution) -> None:
    resolved = made(ev.Resolved, resolution=resolution, helped=True)
    assert untold(lines_of(resolved), FILES) == []


@pytest.mark.parametrize("told", [[], ["ops@example.org"], ["ops@example.org", "b@example.org"]])
def test_a_suspected_false_alarm_is(told: list[str]) -> None:
    alarm = made(ev.SuspectedFalseAlarm, times=3, told=told)
    assert untold(lines_of(alarm), FILES) == []
