"""Stops as whoever carries them out tells of them: set out for, begun, made or failed.

What a robot does is what it set out for, also where the plan has let go of that meanwhile: what
was done counts, and the plan follows. Each function returns the items that are to be sold again.
"""

from math import inf

from mend.fleet.scheduling.replanning.events import EventError
from mend.fleet.scheduling.replanning.fleet_state import FleetState
from mend.fleet.scheduling.replanning.item_state import ItemState, ItemStateError
from mend.fleet.scheduling.replanning.residual_problem import is_given
from mend.fleet.scheduling.replanning.robot_state import TrackedRobot, Trip
from mend.fleet.scheduling.schedule import Action, Task


def set_out(state: FleetState, number: int) -> None:
    """A robot leaves for the next stop of its route. Raises `EventError`."""
    robot, route = state.robots[number], state.routes[number]
    name = robot.robot.name
    if not robot.works:
        raise EventError(f"robot '{name}' does not work; it cannot set out")
    if robot.doing is not None:
        raise EventError(f"robot '{name}' has set out already; say first what came of that")
    if not route:
        raise EventError(f"robot '{name}' has no stop that it could set out for")
    leaves_s, place = max(robot.free_s, state.now_s), route[0].place
    arrival_s = state.travel.trip(robot.place, place, leaves_s, robot.robot.speed).arrival_s
    if arrival_s == inf:
        raise EventError(f"robot '{name}' has no way to {state.building.places[place]} now")
    robot.doing = route[0]
    robot.trip, robot.place, robot.free_s = Trip(robot.place, leaves_s), place, arrival_s
    robot.left_s = leaves_s if robot.left_s is None else robot.left_s


def begin(state: FleetState, number: int) -> None:
    """It is there, and what it has to do takes its time from now on. Raises `EventError`."""
    robot = state.robots[number]
    _doing(robot)
    robot.begun_s = robot.free_s = state.now_s


def make(state: FleetState, number: int, closes: bool) -> list[int]:
    """It has done what it set out for. Raises `EventError` where that cannot be."""
    robot = state.robots[number]
    task = _doing(robot)
    item, kept = state.items[task.item], _is_kept(state, number)
    if not task.action.loads and item.robot != number:
        raise EventError(f"robot '{robot.robot.name}' does not have '{item.item.name}' on board")
    if task.action.loads and not may_have_loaded(state, number):
        place = state.building.places[task.place]
        raise EventError(
            f"item '{item.item.name}' was not left at {place}: nobody can take it there"
        )
    begin_s = state.now_s if robot.begun_s is None else robot.begun_s
    try:
        if _is_in_another_basket(state, number):
            item.change_baskets(number)
            state.note_made(number, task, begin_s, state.now_s)
        else:
            state.record(number, task, begin_s, state.now_s)
    except ItemStateError as error:
        raise EventError(str(error)) from error
    if kept and not closes:
        state.routes[number] = state.routes[number][1:]
    else:
        state.take_out(task.item)
    if closes:
        item.close(ItemState.DELIVERED)
    elif item.withdrawn:
        item.send_back()
    item.withdrawn = False
    if kept or not item.open:
        return []
    item.put_off = None
    return [task.item]


def is_there(state: FleetState, number: int) -> bool:
    """Whether what a robot has set out to load lies where it goes, and was given if it is to be.

    What was never picked up is there for all that is known.
    """
    robot = state.robots[number]
    task = _doing(robot)
    item = state.items[task.item]
    if task.action is Action.TAKE or item.state is not ItemState.WAITING:
        if item.state is not ItemState.LEFT or item.place != task.place:
            return False
        if _is_kept(state, number):
            now = state.routes[number][0]
            return now.action is not Action.TAKE or is_given(state.routes, number, now)
    return True


def may_have_loaded(state: FleetState, number: int) -> bool:
    """Whether a robot may have got what it has set out to load: `is_there`, or people took it out
    of the basket of a robot that has worked again since."""
    return is_there(state, number) or _is_in_another_basket(state, number)


def _is_in_another_basket(state: FleetState, number: int) -> bool:
    """What is taken at a place to change robots is not there before it was given."""
    task = _doing(state.robots[number])
    item = state.items[task.item]
    return task.action is Action.PICK and item.state is ItemState.ABOARD and item.robot != number


def fail(state: FleetState, number: int, at: int, again_s: float | None) -> list[int]:
    """It has not done what it set out for, and is elsewhere now. Raises `EventError`."""
    robot = state.robots[number]
    task = _doing(robot)
    item, kept = state.items[task.item], _is_kept(state, number)
    waits = item.state is ItemState.WAITING
    if kept and waits and again_s is not None and again_s > item.item.pickup.window.latest_s:
        raise EventError(
            f"item '{item.item.name}' must be picked up by {item.item.pickup.window.latest_s:g} s; "
            f"nobody can try that again at {again_s:g} s"
        )
    robot.stand_at(at, state.now_s)
    if item.withdrawn:
        item.withdrawn = False
        item.close(ItemState.CANCELLED)
    if not kept or not item.open:
        return []
    state.take_out(task.item)
    if again_s is not None:
        item.try_again(task.action, again_s)
    elif waits:
        item.close(ItemState.CANCELLED)
        return []
    else:
        item.send_back()
    item.put_off = None
    return [task.item]


def let_go(state: FleetState, number: int, at: int) -> list[int]:
    """Others may do what it has set out for; until it has broken that off it stands at a place.

    Raises `EventError` where they cannot.
    """
    robot = state.robots[number]
    task = _doing(robot)
    if not _is_kept(state, number) or state.items[task.item].robot is not None:
        name, item = robot.robot.name, state.items[task.item].item.name
        raise EventError(f"nobody else can do what robot '{name}' is about with '{item}'")
    state.take_out(task.item)
    robot.trip, robot.place, robot.free_s = Trip(at, state.now_s, keeps=False), at, state.now_s
    return [task.item]


def _doing(robot: TrackedRobot) -> Task:
    if robot.doing is None:
        raise EventError(f"robot '{robot.robot.name}' has not set out for anything")
    return robot.doing


def _is_kept(state: FleetState, number: int) -> bool:
    """Whether the plan still has what the robot set out for as its next stop."""
    return state.robots[number].held and does_next(state, number)


def does_next(state: FleetState, number: int) -> bool:
    """Whether what a robot has set out for is what the plan has as its next stop."""
    doing, route = state.robots[number].doing, state.routes[number]
    if doing is None or not route:
        return False
    same = (doing.place, doing.item) == (route[0].place, route[0].item)
    return same and doing.action.loads == route[0].action.loads
