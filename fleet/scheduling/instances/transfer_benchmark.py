"""Lyu and Yu's pickup and delivery instances with transfers (EJOR 2023), with or without windows.

A node's name says what it is: `p0` and `d0` an item's pickup and delivery, `o0` and `e0` a
vehicle's origin and end, `t0` a transfer place.
"""

from mend.fleet.scheduling.instances.numbers import InstanceError, lines_of_words, number
from mend.fleet.scheduling.problem import Item, Problem, Robot, Transfers, Visit, Window
from mend.fleet.scheduling.travel import Travel

HEADER = ["nr", "nv", "nt", "capacity"]
COLUMNS = 6


def read_transfer_benchmark(text: str, name: str = "pdpt") -> Problem:
    """An instance; one robot may leave an item for another. Raises `InstanceError`."""
    lines = lines_of_words(text)
    if len(lines) < 3 or lines[0][1] != HEADER:
        raise InstanceError(1, f"the first line must be '{' '.join(HEADER)}'")
    line, counts = lines[1]
    if len(counts) != len(HEADER):
        raise InstanceError(line, f"{len(HEADER)} numbers are expected here")
    items, robots, transfers, capacity = (number(word, line) for word in counts)
    nodes = {}
    for line, words in lines[3:]:
        if len(words) != COLUMNS:
            raise InstanceError(line, f"a node has {COLUMNS} columns, but here are {len(words)}")
        nodes[words[0]] = tuple(number(word, line) for word in words[1:])
    index = {node: place for place, node in enumerate(nodes)}

    def place(node: str) -> int:
        if node not in index:
            raise InstanceError(lines[-1][0], f"there is no node '{node}'")
        return index[node]

    def window(node: str) -> Window:
        return Window(nodes[node][2], nodes[node][3])

    points = tuple((node[0], node[1]) for node in nodes.values())
    return Problem(
        name=name,
        places=tuple(nodes),
        travel=Travel.euclidean(points),
        robots=tuple(
            Robot(
                f"v{each}", place(f"o{each}"), place(f"e{each}"), capacity,
                Window(nodes[f"o{each}"][2], nodes[f"e{each}"][3]),
            )
            for each in range(int(robots))
        ),
        items=tuple(
            Item(
                f"r{each}",
                nodes[f"p{each}"][4] if f"p{each}" in nodes else 0.0,
                Visit(place(f"p{each}"), window(f"p{each}")),
                Visit(place(f"d{each}"), window(f"d{each}")),
            )
            for each in range(int(items))
        ),
        transfers=Transfers(tuple(place(f"t{each}") for each in range(int(transfers)))),
        coordinates=points,
    )  # fmt: skip
