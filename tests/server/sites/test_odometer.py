"""An odometer says what was driven since it was read before, as far as that can be known."""

from hypothesis import given
from hypothesis import strategies as st

from mend.robots.link.messages import Driven
from mend.server.sites.odometer import Odometer

metres = st.floats(0.0, 1e6)


def odometer(boot: str, way_m: float, barred_s: float = 0.0) -> Odometer:
    return Odometer(boot, Driven(way_m=way_m, barred_s=barred_s))


@given(metres, metres)
def test_ways_one_after_the_other_add_up(first_m: float, second_m: float) -> None:
    begin, middle = odometer("a", 3.0), odometer("a", 3.0 + first_m)
    end = odometer("a", 3.0 + first_m + second_m)
    parts = [each.way_m for each in (middle.since(begin), end.since(middle)) if each]
    whole = end.since(begin)
    assert whole is not None
    assert abs(sum(parts) - whole.way_m) < 1e-6


def test_what_a_program_drove_that_began_anew_is_not_known() -> None:
    assert odometer("b", 9.0).since(odometer("a", 3.0)) is None
    assert odometer("b", 9.0).since(None) is None


def test_what_is_heard_late_is_not_believed() -> None:
    far = odometer("a", 9.0)
    assert odometer("a", 3.0).later(far) is far
    assert odometer("b", 3.0).later(far).boot == "b"
