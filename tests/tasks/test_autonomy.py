"""What begins by itself at which level of autonomy."""

import pytest

from mend.tasks.autonomy import RECOVERY, AutonomyLevel

OFF, LOW, HIGH, FULL = AutonomyLevel


@pytest.mark.parametrize(
    ("level", "begun"),
    [(OFF, []), (LOW, [OFF]), (HIGH, [OFF, LOW]), (FULL, [OFF, LOW, HIGH])],
)
def test_what_needs_less_than_the_run_allows_begins_by_itself(
    level: AutonomyLevel, begun: list[AutonomyLevel]
) -> None:
    assert [needed for needed in AutonomyLevel if level.allows(needed)] == begun


def test_recoveries_are_asked_for_at_low_and_not_at_high() -> None:
    assert not LOW.allows(RECOVERY)
    assert HIGH.allows(RECOVERY)
