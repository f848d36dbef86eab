"""Who may come and stay, by a clock that the test moves."""

from dataclasses import dataclass, field

import pytest

from mend.server.limits import Limits
from mend.server.refusals import Refusals
from mend.server.visitors import Beyond, ConnectionPhase, Visitor, Visitors

LIMITS = Limits(connections=4, strangers=3, strangers_per_address=2, head_s=10, body_s=60)


@dataclass
class House:
    """Visitors, and what became of them."""

    limits: Limits = LIMITS
    proxies: tuple[str, ...] = ()
    now: float = 0.0
    ended: list[tuple[Visitor, Beyond]] = field(default_factory=list)
    refusals: Refusals = field(default_factory=Refusals)

    def __post_init__(self) -> None:
        self.visitors = Visitors(self.limits, self.refusals, lambda: self.now, self.proxies)

    def come(self, address: str) -> Visitor:
        visitor = self.visitors.come(address, lambda beyond: self.ended.append((visitor, beyond)))
        assert isinstance(visitor, Visitor)
        return visitor

    def why_not(self, address: str) -> str:
        beyond = self.visitors.come(address, lambda _: None)
        assert isinstance(beyond, Beyond)
        return beyond.limit

    def after(self, seconds: float) -> list[tuple[Visitor, str]]:
        """Whom it ends at a moment after the last, and for what."""
        self.now += seconds
        self.ended.clear()
        self.visitors.end_overdue()
        return [(visitor, beyond.limit) for visitor, beyond in self.ended]


@dataclass
class Waiting:
    """A connection with so many bytes that its client has not taken."""

    unread: int = 0

    def get_write_buffer_size(self) -> int:
        return self.unread


def test_one_address_has_only_so_many_strangers() -> None:
    house = House()
    other, *neighbours = [house.come(f"10.0.0.{number}") for number in (2, 1, 1)]
    late = house.come("10.0.0.1")
    assert [(visitor, beyond.limit) for visitor, beyond in house.ended] == [
        (neighbours[0], "strangers_per_address")
    ]
    assert house.refusals.counts["strangers_per_address"] == 1
    neighbours[0].leave()
    late.admit()
    house.come("10.0.0.1")
    assert len(house.ended) == 1
    assert other in (visitor for visitor, _ in house.after(10))


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("2001:db8::1", "2001:db8::ffff:2", True),
        ("2001:db8:0:1::1", "2001:db8:0:2::1", False),
        ("::ffff:10.0.0.1", "10.0.0.1", True),
        ("fe80::1%eth0", "fe80::2%eth0", True),
        ("10.0.0.1", "10.0.0.2", False),
    ],
)
def test_addresses_of_one_customer_count_together(one: str, other: str, same: bool) -> None:
    house = House(Limits(strangers_per_address=1))
    first, _ = house.come(one), house.come(other)
    assert [visitor for visitor, _ in house.ended] == ([first] if same else [])


def test_who_comes_through_a_trusted_proxy_is_not_counted_by_address() -> None:
    house = House(proxies=("10.0.0.1",))
    for _ in range(3):
        house.come("10.0.0.1")
    assert house.ended == []


def test_the_oldest_stranger_makes_room_for_the_next() -> None:
    house = House()
    strangers = [house.come(f"10.0.0.{number}") for number in range(3)]
    strangers[0].admit()
    house.come("10.0.0.8")
    assert house.ended == []
    strangers[2].leave()
    house.come("10.0.0.9")
    assert house.ended == []
    assert len(house.visitors) == 4


def test_the_strangers_that_are_there_longest_are_ended_first() -> None:
    house = House()
    strangers = [house.come(f"10.0.0.{number}") for number in range(4)]
    assert [(visitor, beyond.limit) for visitor, beyond in house.ended] == [
        (strangers[0], "strangers")
    ]
    assert house.refusals.counts["strangers"] == 1


def test_there_are_only_so_many_connections_admitted_or_not() -> None:
    house = House()
    here = [house.come(f"10.0.0.{number}") for number in range(3)]
    for visitor in here:
        visitor.admit()
    here.append(house.come("10.0.0.4"))
    assert house.why_not("10.0.0.5") == "connections"
    here[1].leave()
    here[1].leave()
    house.come("10.0.0.5")
    assert house.why_not("10.0.0.6") == "connections"


def cannot_end(_: Beyond) -> None:
    raise RuntimeError("it cannot be ended")


def test_a_connection_that_cannot_be_ended_costs_no_other_its_end_or_its_place(
    caplog: pytest.LogCaptureFixture,
) -> None:
    house = House()
    house.visitors.come("10.0.0.1", cannot_end)
    others = [house.come("10.0.0.2"), house.come("10.0.0.3"), house.come("10.0.0.4")]
    assert "ending a connection has failed and goes on (RuntimeError: it cannot" in caplog.text
    assert [visitor for visitor, _ in house.after(10)] == others


def test_a_head_has_its_time_from_the_connection_on() -> None:
    house = House()
    visitor = house.come("10.0.0.1")
    assert house.after(9.9) == []
    visitor.enter(ConnectionPhase.HEAD)
    assert house.after(0.1) == [(visitor, "head_s")]
    assert house.after(100.0) == []


def test_a_body_has_its_time_from_the_head_on() -> None:
    house = House()
    visitor = house.come("10.0.0.1")
    house.after(5.0)
    visitor.enter(ConnectionPhase.BODY)
    assert house.after(59.9) == []
    assert house.after(0.1) == [(visitor, "body_s")]


def test_the_service_takes_the_time_that_it_needs() -> None:
    house = House()
    visitor = house.come("10.0.0.1")
    visitor.enter(ConnectionPhase.SERVICE)
    assert house.after(1e6) == []
    visitor.enter(ConnectionPhase.HEAD)
    assert house.after(9.9) == []
    assert house.after(0.1) == [(visitor, "head_s")]


def test_a_client_that_reads_nothing_is_ended_also_when_it_was_admitted() -> None:
    house = House()
    visitor, connection = house.come("10.0.0.1"), Waiting()
    visitor.connected(connection, visitor.end)
    visitor.enter(ConnectionPhase.SERVICE)
    visitor.admit()
    assert house.after(100.0) == []
    connection.unread = 1000
    assert house.after(29.0) == []
    assert house.after(1.0) == [(visitor, "stuck_client_s")]


def test_a_client_that_reads_slowly_stays() -> None:
    house = House()
    visitor, connection = house.come("10.0.0.1"), Waiting(1000)
    visitor.connected(connection, visitor.end)
    visitor.enter(ConnectionPhase.SERVICE)
    for _ in range(10):
        assert house.after(29.0) == []
        connection.unread -= 1
        assert house.after(0.5) == []
    connection.unread = 5000
    assert house.after(29.0) == []
    assert house.after(1.0) == [(visitor, "stuck_client_s")]


def test_of_too_many_connections_of_one_principal_the_oldest_is_ended() -> None:
    house = House(Limits(connections=9, connections_per_principal=2))
    first, second, third = (house.come(f"10.0.0.{number}") for number in range(3))
    for each in (first, second, first, third):
        each.admit("of ada")
    assert [(visitor, beyond.limit) for visitor, beyond in house.ended] == [
        (first, "connections_per_principal")
    ]
    house.come("10.0.0.4").admit("of ben")
    second.leave()
    house.come("10.0.0.5").admit("of ada")
    assert len(house.ended) == 1


def test_a_connection_counts_for_whoever_shows_something_on_it_last() -> None:
    house = House(Limits(connections=9, connections_per_principal=1))
    shared, other = house.come("10.0.0.1"), house.come("10.0.0.1")
    shared.admit("of ada")
    shared.admit("of ben")
    other.admit("of ada")
    assert house.ended == []


def test_who_has_no_credential_of_their_own_and_a_proxy_have_no_share() -> None:
    house = House(Limits(connections=9, connections_per_principal=1), proxies=("10.0.0.9",))
    for address, principal in (("10.0.0.1", None), ("10.0.0.9", "of ada")):
        for _ in range(3):
            house.come(address).admit(principal)
    assert house.ended == []
