"""What is known to be there though only what stands on it is seen."""

from mend.robots.vision.carriers import below, unseen_carriers
from mend.robots.vision.seen_box import SeenBox

TABLE_Z = 0.7


def box(bottom_z: float, height_m: float, name: str | None = "cup", x: float = 0.5) -> SeenBox:
    return SeenBox(x, 0.0, 0.3, (0.04, 0.06, height_m), bottom_z, name, complete=True)


def test_nothing_is_below_what_stands_on_the_table() -> None:
    assert unseen_carriers([box(TABLE_Z + 0.002, 0.05)], TABLE_Z) == []


def test_something_holds_up_a_part_above_the_table() -> None:
    high = box(TABLE_Z + 0.08, 0.05)
    (carrier,) = unseen_carriers([high], TABLE_Z)
    assert carrier == below(high, TABLE_Z)
    assert (carrier.bottom_z, carrier.top_z) == (TABLE_Z, high.bottom_z)
    assert carrier.name == "what cup stands on"
    assert not carrier.complete


def test_what_is_seen_to_stand_on_a_part_or_on_something_unknown_needs_nothing_else() -> None:
    high = box(TABLE_Z + 0.08, 0.05)
    for name in ("tray", None):
        assert unseen_carriers([high, box(TABLE_Z, 0.081, name)], TABLE_Z) == []


def test_what_is_as_high_elsewhere_holds_nothing_up() -> None:
    high = box(TABLE_Z + 0.08, 0.05)
    assert len(unseen_carriers([high, box(TABLE_Z, 0.08, "tray", x=0.7)], TABLE_Z)) == 1


def test_something_unknown_may_be_as_tall_as_it_looks() -> None:
    assert unseen_carriers([box(TABLE_Z + 0.08, 0.05, None)], TABLE_Z) == []
