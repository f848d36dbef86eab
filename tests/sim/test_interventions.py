"""What people have still to do: what a robot sees done is not done again."""

import pytest

from mend.robots.link.messages import Intervene
from mend.sim.interventions import PendingInterventions
from mend.tasks.intervention import Act, Intervention


@pytest.mark.parametrize(
    ("do", "still_done"),
    [
        (Intervention(act=Act.PUT_BACK, object="cup"), False),
        (Intervention(act=Act.PUT_BACK, object="bowl"), True),
        (Intervention(act=Act.RELEASE, object="cup", place="left"), True),
        (Intervention(act=Act.CHARGE, object="arm"), False),
    ],
)
def test_only_who_stands_in_the_way_acts_after_the_robot_saw_it_done(
    do: Intervention, still_done: bool
) -> None:
    pending = PendingInterventions([])
    pending.queue("arm", "c1", Intervene(intervention=do, by="helper"), 3.0)
    pending.withdraw("arm", "cup")
    assert bool(pending.take_due(3.0, None)) is still_done


def test_what_another_robot_was_promised_is_still_done() -> None:
    pending = PendingInterventions([])
    do = Intervention(act=Act.PUT_BACK, object="cup")
    pending.queue("left", "c1", Intervene(intervention=do, by="helper"), 3.0)
    pending.withdraw("right", "cup")
    assert [each.robot for each in pending.take_due(3.0, None)] == ["left"]
