"""When a hypothesis counts: by its margin, by what it means, and by how noisy it was."""

import pytest

pytest.importorskip("pocketsphinx", reason="pocketsphinx is not installed")

from mend.server.speech.commands import Command
from mend.server.speech.decoding import Hypothesis
from mend.server.speech.sureness import (
    MORE_MARGIN,
    NOISY_BELOW_DB,
    NOISY_MARGIN,
    QUIET_MARGIN,
    is_sure,
    stands_out_db,
)


def levels(stands_out_by_db: float) -> list[float]:
    """A voice among as much silence."""
    return [-60.0] * 20 + [-60.0 + stands_out_by_db] * 20


QUIET, NOISY = levels(NOISY_BELOW_DB + 10), levels(NOISY_BELOW_DB - 5)


def heard(command: Command, margin: float) -> Hypothesis:
    return Hypothesis(command.value, command, command.value, margin)


@pytest.mark.parametrize("command", [Command.YES, Command.NO])
def test_an_answer_needs_its_margin_and_more_of_it_in_noise(command: Command) -> None:
    assert is_sure(heard(command, QUIET_MARGIN), QUIET)
    assert not is_sure(heard(command, QUIET_MARGIN - 0.001), QUIET)
    assert not is_sure(heard(command, QUIET_MARGIN), NOISY)
    assert is_sure(heard(command, NOISY_MARGIN), NOISY)


@pytest.mark.parametrize("command", [Command.REPEAT, Command.HELP, Command.STOP])
def test_what_is_no_answer_needs_more(command: Command) -> None:
    assert not is_sure(heard(command, QUIET_MARGIN), QUIET)
    assert is_sure(heard(command, QUIET_MARGIN + MORE_MARGIN), QUIET)


def test_what_is_no_command_never_counts() -> None:
    assert not is_sure(Hypothesis("the weather", margin=1.0), QUIET)


@pytest.mark.parametrize("by_db", [0.0, 12.0, 35.0])
def test_how_far_a_voice_stands_out_does_not_depend_on_how_loud_all_is(by_db: float) -> None:
    assert stands_out_db(levels(by_db)) == pytest.approx(by_db)
    assert stands_out_db([each + 20 for each in levels(by_db)]) == pytest.approx(by_db)
