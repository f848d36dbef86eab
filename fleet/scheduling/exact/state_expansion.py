"""The kernels behind `robot_states`: from a robot's start to every state that it can reach.

A state's key has a bit for each transfer place visited, above them two bits for each item, and
above those the node where the robot is; the start is the node after all others.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mend.fleet.scheduling.tolerance import CHECK_S, LOAD
from mend.maps.compiled import compiled

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Flags = NDArray[np.bool_]

UNTOUCHED, ABOARD, GIVEN, DELIVERED = 0, 1, 2, 3
"""How far an item is with a robot."""
NONE = -1


class Limits(NamedTuple):
    """What a robot can do at its nodes: pickups, deliveries, transfer places, its start.

    `travel_s` from node to node, `to_drop_s` from node to each item's delivery with the fastest
    robot; `give_by_s` and `take_from_s` by item and transfer place; `detours`: whether a transfer
    place is worth a visit where nothing changes robots.
    """

    items: int
    places: int
    to_pick: Flags
    loads: Floats
    capacity: float
    travel_s: Floats
    earliest_s: Floats
    latest_s: Floats
    lasts_s: Floats
    drop_by_s: Floats
    to_drop_s: Floats
    give_by_s: Floats
    take_from_s: Floats
    detours: bool


class Moves(NamedTuple):
    """From state to state by way of a node, where items are given and taken (bits).

    It takes until it has lasted, counted from the arrival, and is not over before `over_from_s`.
    """

    origin: Integers
    target: Integers
    node: Integers
    gives: Integers
    takes: Integers
    arrives_by_s: Floats
    over_from_s: Floats
    lasts_s: Floats


class States(NamedTuple):
    """States as they are found: a hash table of their keys, when they are reached at the earliest,
    and those of each level as a linked list."""

    table: Integers
    keys: Integers
    reached_s: Floats
    heads: Integers
    following: Integers


@compiled
def new_moves(most: int) -> Moves:
    """Room for so many moves."""
    return Moves(
        np.empty(most, np.int64), np.empty(most, np.int64), np.empty(most, np.int64),
        np.empty(most, np.int64), np.empty(most, np.int64),
        np.empty(most), np.empty(most), np.empty(most),
    )  # fmt: skip


@compiled
def first_moves(moves: Moves, count: int) -> Moves:
    """A copy of so many moves."""
    return Moves(
        moves.origin[:count].copy(), moves.target[:count].copy(), moves.node[:count].copy(),
        moves.gives[:count].copy(), moves.takes[:count].copy(),
        moves.arrives_by_s[:count].copy(), moves.over_from_s[:count].copy(),
        moves.lasts_s[:count].copy(),
    )  # fmt: skip


@compiled
def new_states(most: int, levels: int) -> States:
    """Room for so many states."""
    rows = 1
    while rows < 2 * most:
        rows *= 2
    return States(
        np.full(rows, NONE, np.int64), np.empty(most, np.int64), np.empty(most),
        np.full(levels, NONE, np.int64), np.empty(most, np.int64),
    )  # fmt: skip


@compiled
def progress_of(key: int, item: int, places: int) -> int:
    """How far an item is."""
    return (key >> (places + 2 * item)) & 3


@compiled
def with_progress(key: int, item: int, places: int, progress: int) -> int:
    """The key after an item has come so far."""
    shift = places + 2 * item
    return (key & ~(3 << shift)) | (progress << shift)


@compiled
def level_of(key: int, limits: Limits) -> int:
    """Every move leads to a higher level: more places visited, or more picked or delivered."""
    level = 0
    for place in range(limits.places):
        level += ((key >> place) & 1) * (2 * limits.items + 1)
    for item in range(limits.items):
        progress = progress_of(key, item, limits.places)
        level += (progress == ABOARD) + 2 * (progress == DELIVERED)
    return level


@compiled
def find_row(states: States, key: int) -> int:
    """The row of the table where a key is, or where it belongs."""
    last = states.table.shape[0] - 1
    mixed = (key ^ (key >> 17)) * 0x2545F491
    mixed = (mixed ^ (mixed >> 13)) * 0x297A2D39
    row: int = (mixed ^ (mixed >> 16)) & last
    while states.table[row] != NONE and states.keys[states.table[row]] != key:
        row = (row + 1) & last
    return row


@compiled
def find_state(states: States, count: int, key: int, over_s: float, limits: Limits) -> int:
    """The state with a key, reached at a time; a new one has the number `count`."""
    row = find_row(states, key)
    if states.table[row] == NONE:
        if count == states.keys.shape[0]:
            return NONE
        states.table[row] = count
        states.keys[count], states.reached_s[count] = key, over_s
        level = level_of(key, limits)
        states.following[count] = states.heads[level]
        states.heads[level] = count
    found = int(states.table[row])
    states.reached_s[found] = min(states.reached_s[found], over_s)
    return found


@compiled
def with_robot(key: int, limits: Limits) -> tuple[int, int, float]:
    """What is aboard and what could be taken from others (bits), and the load."""
    aboard, elsewhere, load = 0, 0, 0.0
    for item in range(limits.items):
        progress = progress_of(key, item, limits.places)
        if progress == ABOARD:
            aboard |= 1 << item
            load += limits.loads[item]
        elif progress != DELIVERED:
            elsewhere |= 1 << item
    return aboard, elsewhere, load


@compiled
def givable(aboard: int, place: int, arrives_s: float, limits: Limits) -> int:
    """What of that aboard could still be delivered in time after changing robots at a place."""
    possible = 0
    for item in range(limits.items):
        if (aboard >> item) & 1 and arrives_s <= limits.give_by_s[item, place] + CHECK_S:
            possible |= 1 << item
    return possible


@compiled
def may_visit(key: int, node: int, aboard: int, load: float, limits: Limits) -> bool:
    """Whether a robot may do what there is to do at a node, times aside."""
    items = limits.items
    if node < items:
        untouched = progress_of(key, node, limits.places) == UNTOUCHED
        fits = load + limits.loads[node] <= limits.capacity + LOAD
        return bool(limits.to_pick[node] and untouched and fits)
    if node < 2 * items:
        return (aboard >> (node - items)) & 1 == 1
    return (key >> (node - 2 * items)) & 1 == 0


@compiled
def after_visit(key: int, node: int, given: int, taken: int, limits: Limits) -> int:
    """The key after a node."""
    items, places = limits.items, limits.places
    shift = places + 2 * items
    key = (key & ((1 << shift) - 1)) | (node << shift)
    if node < items:
        return with_progress(key, node, places, ABOARD)
    if node < 2 * items:
        return with_progress(key, node - items, places, DELIVERED)
    for item in range(items):
        if (given >> item) & 1:
            key = with_progress(key, item, places, GIVEN)
        elif (taken >> item) & 1:
            key = with_progress(key, item, places, ABOARD)
    return key | (1 << (node - 2 * items))


@compiled
def visit_times(node: int, given: int, taken: int, limits: Limits) -> tuple[float, float, float]:
    """When a robot has to arrive at the latest, is ready at the earliest, and how long it takes."""
    by_s, lasts_s = limits.latest_s[node], limits.lasts_s[node]
    if node < 2 * limits.items:
        return by_s, limits.earliest_s[node] + lasts_s, lasts_s
    place, over_from_s, in_all_s = node - 2 * limits.items, 0.0, 0.0
    for item in range(limits.items):
        if (given >> item) & 1:
            by_s = min(by_s, limits.give_by_s[item, place])
            in_all_s += lasts_s
        elif (taken >> item) & 1:
            over_from_s = max(over_from_s, limits.take_from_s[item, place] + lasts_s)
            in_all_s += lasts_s
    return by_s, over_from_s, in_all_s


@compiled
def in_time(key: int, node: int, over_s: float, limits: Limits) -> bool:
    """Whether the robot can be home in time, and what is aboard where it belongs, with whomever."""
    if not over_s < min(np.inf, limits.latest_s[node] + limits.lasts_s[node] + CHECK_S):
        return False
    for item in range(limits.items):
        aboard = progress_of(key, item, limits.places) == ABOARD
        if aboard and over_s + limits.to_drop_s[node, item] > limits.drop_by_s[item] + CHECK_S:
            return False
    return True


@compiled
def add_visits(
    states: States, moves: Moves, counts: Integers, state: int, node: int, limits: Limits
) -> bool:
    """All ways to go on from a state by way of a node; False where there is no more room."""
    key = states.keys[state]
    here = key >> (limits.places + 2 * limits.items)
    arrives_s = states.reached_s[state] + limits.travel_s[here, node]
    aboard, elsewhere, load = with_robot(key, limits)
    if node == here or not arrives_s < min(np.inf, limits.latest_s[node] + CHECK_S):
        return True
    if not may_visit(key, node, aboard, load, limits):
        return True
    transfer = node >= 2 * limits.items
    may_give = givable(aboard, node - 2 * limits.items, arrives_s, limits) if transfer else 0
    may_exchange = may_give | elsewhere if transfer else 0
    exchanged = may_exchange
    while True:
        given, taken = exchanged & may_give, exchanged & ~may_give
        after = after_visit(key, node, given, taken, limits)
        by_s, over_from_s, lasts_s = visit_times(node, given, taken, limits)
        over_s = max(arrives_s + lasts_s, over_from_s)
        _, _, load = with_robot(after, limits)
        useful = exchanged != 0 or not transfer or limits.detours
        possible = arrives_s <= by_s + CHECK_S and in_time(after, node, over_s, limits)
        if useful and possible and load <= limits.capacity + LOAD:
            number = counts[1]
            if number == moves.node.shape[0]:
                return False
            target = find_state(states, counts[0], after, over_s, limits)
            if target == NONE:
                return False
            counts[0] = max(counts[0], target + 1)
            moves.origin[number], moves.target[number], moves.node[number] = state, target, node
            moves.gives[number], moves.takes[number] = given, taken
            moves.arrives_by_s[number], moves.lasts_s[number] = by_s, lasts_s
            moves.over_from_s[number] = over_from_s
            counts[1] += 1
        if exchanged == 0:
            return True
        exchanged = (exchanged - 1) & may_exchange


@compiled
def expand(
    limits: Limits, aboard: int, starts_s: float, most_states: int, most_moves: int
) -> tuple[Integers, Integers, Moves]:
    """The keys of all states, low levels first, where the moves of each begin, and the moves.

    These tell states by their row. There are none where there was not enough room.
    """
    levels = (limits.places + 1) * (2 * limits.items + 1)
    states, moves = new_states(most_states, levels), new_moves(most_moves)
    key = (2 * limits.items + limits.places) << (limits.places + 2 * limits.items)
    for item in range(limits.items):
        if (aboard >> item) & 1:
            key = with_progress(key, item, limits.places, ABOARD)
    find_state(states, 0, key, starts_s, limits)
    counts = np.array([1, 0])
    order, first = np.empty(most_states, np.int64), np.zeros(most_states + 1, np.int64)
    row = np.empty(most_states, np.int64)
    done = 0
    for level in range(levels):
        state = states.heads[level]
        while state != NONE:
            order[done], row[state] = states.keys[state], done
            for node in range(2 * limits.items + limits.places):
                if not add_visits(states, moves, counts, state, node, limits):
                    return order[:0], first[:1], first_moves(moves, 0)
            done += 1
            first[done] = counts[1]
            state = states.following[state]
    for move in range(counts[1]):
        moves.origin[move] = row[moves.origin[move]]
        moves.target[move] = row[moves.target[move]]
    return order[:done], first[: done + 1], first_moves(moves, counts[1])
