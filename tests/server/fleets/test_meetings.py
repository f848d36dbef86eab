"""Where robots say that they are, and what those are told that have met."""

import math

from building_bench import made_up

from mend.fleet.right_of_way.right_of_way import AGAIN_S
from mend.robots.link.messages import IDENTITY, BaseLimits, Poses
from mend.server.fleets.meetings import PATIENCE_S, Meetings, Occupation
from mend.tasks.frames import Frame

ROOM, OTHER = "F1/101", "F1/103"
FRAMES = {"ada": Frame(), "bob": Frame(3.0, -1.0, 1)}
BASE = BaseLimits(radius_m=0.25, speed_m_s=1.0)
LATE_S = 40.0
"""The clock of bob is so far ahead."""


class Door:
    """Two robots on both sides of a door, the first outside."""

    def __init__(self, reachable: tuple[str, ...] = ()) -> None:
        self.building = made_up()
        self.occupations = {"ada": Occupation(goal=ROOM), "bob": Occupation(goal=OTHER)}
        self.bases = {"ada": BASE, "bob": BASE}
        self.meetings = Meetings(
            self.building,
            FRAMES,
            reachable,
            lambda robot: self.occupations[robot],
            lambda robot: self.bases.get(robot),
        )
        floor = self.building.floors["F1"]
        (ax, ay), (bx, by) = floor.doors["101"].posts
        room, x, y = floor.places["101"], (ax + bx) / 2.0, (ay + by) / 2.0
        away_m = math.dist((x, y), (room.x, room.y))
        off = 0.4 * (room.x - x) / away_m, 0.4 * (room.y - y) / away_m
        self.at = {"ada": (x - off[0], y - off[1]), "bob": (x + off[0], y + off[1])}

    def say(self, robot: str, time_s: float, *, barred: bool | None = True) -> bool:
        """A robot says where it is; whether that may be a meeting."""
        x, y = FRAMES[robot].to_robot(*self.at[robot])
        base = (x, y, *IDENTITY[2:])
        ahead_s = LATE_S if robot == "bob" else 0.0
        time_s += ahead_s
        poses = Poses(time=time_s, base=base, tool=IDENTITY, opening_m=0.0, barred=barred)
        return self.meetings.take(robot, poses)

    def stand(self, *, bob: bool | None = True) -> bool:
        """Both have stood for a while; whether that may be a meeting."""
        for time_s in (0.0, PATIENCE_S):
            found = [self.say("ada", time_s), self.say("bob", time_s, barred=bob)]
        return any(found)


def test_who_stands_for_a_moment_has_met_nobody() -> None:
    door = Door()
    assert not door.say("ada", 0.0)
    assert not door.say("ada", PATIENCE_S / 2.0)
    assert not door.say("ada", PATIENCE_S / 2.0 + 0.1, barred=False)
    assert not door.say("ada", PATIENCE_S)
    assert door.say("ada", 2.0 * PATIENCE_S)


def test_both_are_told_in_their_own_frames_and_clocks() -> None:
    door = Door()
    assert door.stand()
    standings = door.meetings.standings()
    assert set(standings) == {"ada", "bob"}
    decided = door.meetings.decide(standings, 5.0)
    assert decided is not None
    told = dict(door.meetings.told(decided, 5.0))
    makes, waits = told[decided.robot], told[decided.other]
    assert (makes.other, waits.other) == (decided.other, decided.robot)
    assert waits.way == []
    back = [FRAMES[decided.robot].to_scene(each.x, each.y) for each in makes.way]
    assert all(math.dist(a, b) < 1e-6 for a, b in zip(back, decided.way, strict=True))
    assert told["bob"].until - told["ada"].until == LATE_S
    assert told["ada"].until == PATIENCE_S + decided.until_s - 5.0


def test_who_has_come_off_the_lane_is_not_thought_to_go_back_to_it_first() -> None:
    door = Door()
    assert door.stand()
    for robot, goal in (("ada", "101"), ("bob", "101")):
        door.occupations[robot] = Occupation(goal=f"F1/{goal}")
    for standing in door.meetings.standings().values():
        steps = [math.dist(each, standing.way[-1]) for each in standing.way]
        assert steps == sorted(steps, reverse=True), "it gets nearer all the way"


def test_who_rests_there_is_sent_to_a_place_that_is_off_the_way() -> None:
    door = Door(("F1/101", "F1/102", "F1/104"))
    door.occupations["bob"] = Occupation(rests=True)
    assert door.stand(bob=None)
    standings = door.meetings.standings()
    decided = door.meetings.decide(standings, 5.0)
    assert decided is not None
    assert decided.robot == "bob"
    assert door.meetings.place_to_rest(decided, standings) in {"F1/102", "F1/104"}


def test_who_can_be_sent_nowhere_stays_there() -> None:
    door = Door(("F1/101",))
    door.occupations["bob"] = Occupation(rests=True)
    assert door.stand(bob=None)
    standings = door.meetings.standings()
    decided = door.meetings.decide(standings, 5.0)
    assert decided is not None
    assert door.meetings.place_to_rest(decided, standings) is None
    assert door.meetings.decide(standings, 5.5) is None
    door.meetings.take_back(decided, 5.5)
    assert door.meetings.decide(standings, 5.5 + AGAIN_S / 2.0) is None
    again = door.meetings.decide(standings, 5.5 + 2.0 * AGAIN_S)
    assert again is not None
    assert (again.robot, again.other) == (decided.robot, decided.other)


def test_who_does_not_say_how_wide_it_is_is_only_driven_round() -> None:
    door = Door()
    del door.bases["bob"]
    assert door.stand()
    standings = door.meetings.standings()
    assert standings["bob"].radius_m == BASE.radius_m
    assert not standings["bob"].barred
    decided = door.meetings.decide(standings, 5.0)
    assert decided is not None
    assert decided.robot == "ada"


def test_nobody_makes_way_for_who_is_at_work_or_gone() -> None:
    for occupation in (Occupation(), Occupation(goal=ROOM)):
        door = Door()
        door.occupations["bob"] = occupation
        if occupation.goal is not None:
            room = door.building.floors["F1"].places["101"]
            x, y = room.x, room.y
            near = door.at["ada"]
            away_m = math.dist(near, (x, y))
            door.at["bob"] = x, y
            door.at["ada"] = x + 0.7 * (near[0] - x) / away_m, y + 0.7 * (near[1] - y) / away_m
        assert door.stand(bob=None)
        assert door.meetings.decide(door.meetings.standings(), 5.0) is None
