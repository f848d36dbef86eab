"""Robots that work no more, and work again: what becomes of what they have in their baskets.

Each function returns the items that are to be sold again.
"""

from mend.fleet.scheduling.replanning.events import EventError, RobotBack, RobotFailed
from mend.fleet.scheduling.replanning.fleet_state import FleetState
from mend.fleet.scheduling.replanning.item_state import ItemState
from mend.fleet.scheduling.replanning.on_the_way import stand_still


def fail(state: FleetState, event: RobotFailed) -> list[int]:
    """A robot stands still; others do what it was to do. Raises `EventError`."""
    name, lost = event.robot, event.lost
    number = state.robot_number(name)
    robot = state.robots[number]
    if not robot.works:
        raise EventError(f"robot '{name}' has failed already")
    place = None if event.at is None else state.place_number(event.at)
    aboard = {
        n: item
        for n, item in enumerate(state.items)
        if item.robot == number and item.state is ItemState.ABOARD
    }
    unknown = lost - {item.item.name for item in aboard.values()}
    if unknown:
        raise EventError(f"robot '{name}' does not have {', '.join(sorted(unknown))} on board")
    doing = robot.doing
    if place is None:
        stand_still(robot, state.ways, state.now_s)
    robot.stand_at(robot.place if place is None else place, state.now_s)
    robot.works = False
    if doing is not None and state.items[doing.item].withdrawn:
        state.items[doing.item].withdrawn = False
        state.items[doing.item].close(ItemState.CANCELLED)
    moved = {task.item for task in state.routes[number]} | set(aboard)
    for n, item in aboard.items():
        item.put_off = None
        if item.item.name in lost:
            moved.remove(n)
            state.take_out(n)
            item.close(ItemState.LOST)
        else:
            item.stand_with(robot.place, state.now_s)
    for n in moved:
        state.take_out(n, keep_pickups=True)
    state.moved_by[number] = moved
    return sorted(moved)


def be_elsewhere(state: FleetState, number: int, place: int) -> list[int]:
    """One that works no more stands at another place now: who fetches what it has goes there."""
    state.robots[number].stand_at(place, state.now_s)
    held = [n for n, item in enumerate(state.items) if item.held_by == number]
    for n in held:
        state.take_out(n)
        state.items[n].stand_elsewhere(place)
    return [n for n in held if state.items[n].open]


def come_back(state: FleetState, event: RobotBack) -> list[int]:
    """A robot works again, with what is still in its basket: whoever was to fetch that does not.

    Raises `EventError`.
    """
    number = state.robot_number(event.robot)
    robot, place = state.robots[number], state.place_number(event.place)
    if robot.works:
        raise EventError(f"robot '{event.robot}' works already")
    robot.works = True
    robot.stand_at(place, max(state.now_s, robot.robot.shift.earliest_s))
    kept = [n for n, item in enumerate(state.items) if item.held_by == number]
    for n in kept:
        state.take_out(n)
        state.items[n].go_on_with()
    return [n for n in kept if state.items[n].open]
