"""The earliest time within which an item that has no place as it is would have one."""

from dataclasses import replace
from math import ceil, inf

from mend.fleet.scheduling.problem import Item, Window
from mend.fleet.scheduling.replanning.events import NewItem
from mend.fleet.scheduling.replanning.running_fleet import RunningFleet

ROUNDS = 10
ENOUGH_S = 60.0
"""An earlier time is not looked for where it would be earlier by less."""


def next_possible(
    fleet: RunningFleet, item: Item, *, longest_s: float, grace_s: float
) -> Window | None:
    """From when until when; None where nothing is found. The fleet stays as it is.

    What is returned has been tried: the fleet as it is has a place for it.
    """
    earliest_s = max(item.pickup.window.earliest_s, fleet.now_s)
    limit_s = earliest_s + longest_s
    done_s = _done_by_s(fleet, item, limit_s)
    if done_s is None:
        return None
    too_early_s = max(item.pickup.window.latest_s, earliest_s)
    too_early_s = earliest_s if too_early_s == inf else too_early_s
    for _ in range(ROUNDS):
        if done_s - too_early_s <= ENOUGH_S:
            break
        middle_s = (done_s + too_early_s) / 2
        found_s = _done_by_s(fleet, item, middle_s)
        if found_s is None:
            too_early_s = middle_s
        else:
            done_s = found_s
    # A search that gives up now and then may find no place where there is more time.
    for latest_s in (ceil(done_s + grace_s), done_s, limit_s):
        if _done_by_s(fleet, item, latest_s) is not None:
            return Window(item.pickup.window.earliest_s, latest_s)
    return None


def bounded(item: Item, latest_s: float) -> Item:
    """The item, to be done by a time."""
    pickup, delivery = item.pickup, item.delivery
    pickup = replace(pickup, window=Window(pickup.window.earliest_s, latest_s))
    if delivery.place != pickup.place:
        delivery = replace(delivery, window=Window(delivery.window.earliest_s, latest_s))
    return replace(item, pickup=pickup, delivery=delivery)


def _done_by_s(fleet: RunningFleet, item: Item, latest_s: float) -> float | None:
    """When its last stop would begin, if it has to by then; None where it has no place."""
    trial = fleet.fork()
    if latest_s < item.pickup.window.earliest_s:
        return None
    if trial.apply(NewItem(bounded(item, latest_s)), trial.now_s).refused:
        return None
    stops = [each for made in trial.stops().values() for each in made if each.item == item.name]
    first, last = min(each.begin_s for each in stops), max(each.begin_s for each in stops)
    return first if item.delivery.place == item.pickup.place else last
