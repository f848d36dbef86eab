"""The steps of meeting and leading somebody, and what is refused before any of them."""

import pytest
from pydantic import ValidationError

from mend.robots.base.behaviors.behavior import BaseSituation, Drive
from mend.robots.base.behaviors.escort import Escort
from mend.robots.base.behaviors.meet_person import MeetPerson, PersonParameters
from mend.robots.base.body import BasePose
from mend.robots.base.companion import NoCompanion
from mend.robots.base.ways import StraightWays
from mend.robots.execution.command_error import CommandError

HERE, THERE = BasePose(0.0, 0.0, 0.0), BasePose(3.0, 0.0, 0.0)
LEE = PersonParameters(place="office", person="Ms Lee")


class Badge(NoCompanion):
    """One that senses people."""

    range_m = 6.0


def situation(companion: NoCompanion | None = None) -> BaseSituation:
    places = {"office": THERE}
    companion = companion or Badge()
    return BaseSituation(HERE, places, THERE, StraightWays(), companion=companion)


def test_it_meets_somebody_and_then_leads_them_slowly() -> None:
    met, led = MeetPerson().steps(LEE, situation()), Escort().steps(LEE, situation())
    assert [each.name for each in met] == ["go to office", "meet Ms Lee"]
    assert [each.name for each in led] == ["go to office", "arrive with Ms Lee"]
    alone, leading = met[0], led[0]
    assert isinstance(alone, Drive)
    assert isinstance(leading, Drive)
    assert (alone.leads, leading.leads) == (None, "Ms Lee")
    assert leading.speed < alone.speed


@pytest.mark.parametrize("behavior", [MeetPerson(), Escort()])
def test_who_senses_nobody_leads_nobody(behavior: MeetPerson | Escort) -> None:
    with pytest.raises(CommandError, match="does not sense who follows it"):
        behavior.steps(LEE, situation(NoCompanion()))


@pytest.mark.parametrize("person", ["", " Lee", "a\nb", 'Ann "Lee"', "a\u202eb", "x" * 101])
def test_names_that_could_not_be_shown_as_they_are_get_refused(person: str) -> None:
    with pytest.raises(ValidationError):
        PersonParameters(place="office", person=person)


@pytest.mark.parametrize("person", ["Ms Lee", "Jean-Luc O'Neill", "李雷", "the guest of 305"])
def test_people_are_called_as_they_are_called(person: str) -> None:
    assert PersonParameters(place="office", person=person).person == person
