"""A robot that the service runs itself is no stranger, and so is never ended as one too many."""

from starlette.requests import HTTPConnection

from mend.server.access.access import Access
from mend.server.limits import Limits
from mend.server.refusals import Refusals
from mend.server.robots.passes import OwnRobots
from mend.server.visitors import STATE_KEY, Beyond, Visitor, Visitors


def test_a_robot_of_the_service_is_admitted_however_many_strangers_come() -> None:
    ended: list[Beyond] = []
    visitors = Visitors(Limits(strangers=1), Refusals(), lambda: 0.0)
    robots = OwnRobots()
    robot = visitors.come("127.0.0.1", ended.append)
    assert isinstance(robot, Visitor)
    shown = b"Bearer " + robots.issue("pr2").encode()
    connection = HTTPConnection(
        {"type": "websocket", "headers": [(b"authorization", shown)], "state": {STATE_KEY: robot}}
    )
    access = Access("t" * 32, own_robots=robots, wall_time_s=lambda: 0.0)
    found = access.own_robot(connection)
    assert found is not None
    assert found.why_not("pr2") is None
    for number in range(3):
        visitors.come(f"192.0.2.{number}", lambda _: None)
    assert ended == []
