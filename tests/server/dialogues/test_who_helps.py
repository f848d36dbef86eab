"""Everybody may see who helps, and nobody since when."""

from uuid import UUID

from mend.server.dialogues.duty import Duty, WaitingQuestion
from mend.server.dialogues.escalation import EscalationPolicy
from mend.server.dialogues.who_helps import HelperView, who_helps


def test_who_is_here_away_called_or_not_to_be_reached_and_busy() -> None:
    policy = EscalationPolicy(helpers=("ana", "ben", "cem", "eve"))
    on = [(UUID(int=7), "ben"), (UUID(int=7), "ben")]
    asked = [WaitingQuestion(UUID(int=1), ["ana", "dan"]), WaitingQuestion(UUID(int=2), ["dan"])]
    duty = Duty(["dan", "ben", "cem"], on, asked, away=["cem"], called=["ana", "flo"])
    assert who_helps(policy, duty).in_turn
    assert who_helps(policy, duty).helpers == [
        HelperView(helper="ana", reach="called", on=0, asked=0),
        HelperView(helper="ben", reach="here", on=1, asked=0),
        HelperView(helper="cem", reach="away", on=0, asked=0),
        HelperView(helper="eve", reach="gone", on=0, asked=0),
        HelperView(helper="dan", reach="here", on=0, asked=2),
    ]


def test_where_everybody_is_asked_whoever_is_called_helps() -> None:
    duty = Duty(["dan"], called=["flo", "dan"])
    found = who_helps(EscalationPolicy(), duty)
    assert not found.in_turn
    assert [each.helper for each in found.helpers] == ["dan", "flo"]
