"""Whatever people do, nothing is lost or doubled, and a rebuilt world has all where it was."""

import json
from collections.abc import Callable

import numpy as np
import pytest

from mend.sim.building.goods import MOST_ITEMS, Goods, ItemSnapshot, Wish, WishSnapshot

PLACES = ("a", "b", "c")
NAMES = ("mail", "keys", "lunch", "parcel", "book", "cup")
ROBOTS = 2


def anywhere(_robot: int, _place: str | None) -> bool:
    return True


def nowhere(_robot: int, _place: str | None) -> bool:
    return False


def far_off(_robot: int, _other: int) -> bool:
    return False


def near_or_far(rng: np.random.Generator) -> Callable[[int, int], bool]:
    near = bool(rng.random() < 0.5)
    return lambda _robot, _other: near


def goods(forgetful: float = 0.0, seed: int = 3) -> Goods:
    return Goods(seed, forgetful, np.random.default_rng(seed))


def kept(made: Goods) -> str:
    items, wishes = made.snapshot()
    return json.dumps(
        [
            {name: each.model_dump() for name, each in items.items()},
            {robot: each.model_dump() for robot, each in wishes.items()},
        ]
    )


def rebuilt(made: Goods) -> Goods:
    items, wishes = json.loads(kept(made))
    again = goods(made.forgetful)
    again.restore(
        {name: ItemSnapshot.model_validate(each) for name, each in items.items()},
        {int(robot): WishSnapshot.model_validate(each) for robot, each in wishes.items()},
    )
    return again


def wish(made: Goods, item: str, place: str, *, hands_over: bool = False, robot: int = 0) -> None:
    made.wishes.pop(robot, None)
    made.wish(robot, Wish(item, place, hands_over))


def act_somehow(made: Goods, rng: np.random.Generator) -> None:
    item, place = rng.choice(NAMES), rng.choice(PLACES)
    robot = int(rng.integers(ROBOTS))
    stands = anywhere if rng.random() < 0.9 else nowhere
    match int(rng.integers(6)):
        case 0:
            wish(made, str(item), str(place), robot=robot)
        case 1:
            wish(made, str(item), str(place), hands_over=True, robot=robot)
        case 2 | 3:
            made.put_in(None if rng.random() < 0.5 else str(item), stands, near_or_far(rng))
        case 4:
            made.take_out(None if rng.random() < 0.5 else str(item), stands)
        case _:
            made.steal(str(rng.choice(list(made.items) or [str(item)])))


@pytest.mark.parametrize("seed", range(20))
def test_nothing_is_lost_or_doubled_by_whatever_people_do(seed: int) -> None:
    rng = np.random.default_rng(seed)
    made = goods(forgetful=0.4, seed=seed)
    weights: dict[str, float] = {}
    for _ in range(300):
        act_somehow(made, rng)
        assert weights.items() <= {n: each.weight_kg for n, each in made.items.items()}.items()
        weights = {name: each.weight_kg for name, each in made.items.items()}
        for each in made.items.values():
            kept_by_thief = each.taken and each.robot is None
            where = [each.place is not None, each.robot is not None, kept_by_thief]
            assert where.count(True) == 1, "it is in one place"
            assert not each.taken or each.place is None
        for robot in range(ROBOTS):
            inside = [e for e in made.items.values() if e.robot == robot and not e.taken]
            assert made.load_kg(robot) == pytest.approx(sum(e.weight_kg for e in inside))
            assert len([e for e in made.items.values() if e.robot == robot]) <= MOST_ITEMS
        assert kept(rebuilt(made)) == kept(made)


def test_a_thing_is_with_somebody_where_it_is_first_asked_for() -> None:
    made = goods()
    wish(made, "mail", "a")
    assert made.put_in("mail", anywhere, far_off) == ""
    assert made.items["mail"].robot == 0
    assert 0.2 <= made.load_kg(0) <= 2.0


def test_what_is_elsewhere_cannot_be_put_in_a_second_time() -> None:
    made = goods()
    wish(made, "mail", "a")
    made.put_in("mail", anywhere, far_off)
    wish(made, "mail", "a", robot=1)
    made.wishes.pop(0)
    assert (
        made.put_in("mail", anywhere, far_off)
        == "nobody at 'a' has 'mail': it is in a robot's basket"
    )
    wish(made, "mail", "b", hands_over=True)
    assert made.take_out("mail", anywhere) == ""
    assert made.items["mail"].delivered
    assert (
        made.put_in("mail", anywhere, far_off)
        == "nobody at 'a' has 'mail': it is with somebody at 'b'"
    )
    assert len(made.items) == 1


def test_a_robot_that_does_not_stand_there_is_given_nothing() -> None:
    made = goods()
    wish(made, "mail", "a")
    assert made.put_in(None, nowhere, far_off) == "no robot asks for anything where it stands"
    assert not made.items


def test_what_was_taken_on_the_way_comes_back() -> None:
    made = goods()
    wish(made, "mail", "a")
    made.put_in("mail", anywhere, far_off)
    made.wishes.clear()
    assert made.steal("mail") == ""
    assert made.load_kg(0) == 0.0
    assert made.steal("mail") == "'mail' is in no robot's basket"
    assert made.put_in(None, anywhere, far_off) == ""
    assert made.load_kg(0) == made.items["mail"].weight_kg


def test_who_takes_what_is_handed_over_to_somebody_else_keeps_it() -> None:
    made = goods()
    wish(made, "mail", "a")
    made.put_in("mail", anywhere, far_off)
    wish(made, "mail", "b", hands_over=True)
    assert made.steal("mail") == ""
    made.wishes.clear()
    wish(made, "keys", "a")
    assert made.put_in(None, anywhere, far_off) == ""
    mail = made.items["mail"]
    assert (mail.place, mail.robot, mail.taken, mail.delivered) == (None, None, True, False)
    assert made.load_kg(0) == made.items["keys"].weight_kg


def test_who_forgets_does_nothing_or_puts_in_something_else_and_takes_that_out_again() -> None:
    made = goods(forgetful=1.0)
    wish(made, "mail", "a")
    said = {made.put_in("mail", anywhere, far_off) for _ in range(20)}
    assert said == {
        "somebody put something else into the basket",
        "somebody forgot to put 'mail' into the basket",
    }
    assert "mail" not in made.items
    made.forgetful = 0.0
    assert made.put_in("mail", anywhere, far_off) == ""
    assert made.load_kg(0) == made.items["mail"].weight_kg


def test_who_takes_something_else_out_puts_it_back() -> None:
    made = goods()
    for each in ("mail", "keys"):
        wish(made, each, "a")
        made.put_in(each, anywhere, far_off)
    wish(made, "mail", "b", hands_over=True)
    made.forgetful = 1.0
    while made.items["keys"].robot is not None:
        made.take_out("mail", anywhere)
    made.forgetful = 0.0
    assert made.take_out("mail", anywhere) == ""
    assert made.items["keys"].robot == 0
    assert made.items["mail"].place == "b"


def test_weights_are_drawn_by_the_seed_and_the_name_alone() -> None:
    one, other = goods(seed=5), goods(seed=5)
    for made, order in ((one, ("mail", "keys")), (other, ("keys", "mail"))):
        for each in order:
            wish(made, each, "a")
            made.put_in(each, anywhere, far_off)
    assert one.items["mail"].weight_kg == other.items["mail"].weight_kg
    assert one.items["mail"].weight_kg != one.items["keys"].weight_kg


def test_what_a_robot_has_that_does_not_get_on_is_brought_to_the_one_that_fetches_it() -> None:
    made = goods()
    wish(made, "mail", "a")
    assert made.put_in("mail", anywhere, far_off) == ""
    made.wishes.pop(0)
    wish(made, "mail", "b", robot=1)
    assert made.put_in("mail", anywhere, far_off) == (
        "nobody at 'b' has 'mail': it is in a robot's basket"
    )
    assert made.put_in("mail", anywhere, lambda robot, other: (robot, other) == (1, 0)) == ""
    assert made.load_kg(0) == 0.0
    assert made.load_kg(1) == made.items["mail"].weight_kg
