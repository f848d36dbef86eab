"""The nodes of a task tree in columns, so that a large one consists of few objects.

A hundred thousand objects each a node would make every collection of garbage a pause.
"""

from array import array
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from pydantic import JsonValue

from mend.tasks.autonomy import LEVELS, AutonomyLevel
from mend.tasks.definition import BehaviorNode, GoalNode, NodeKind, TaskTreeDefinition
from mend.tasks.tree_shape import TreeShape

NO_CODE = -1

_NONE: Mapping[str, JsonValue] = {}


class NodeTable:
    """Names, shape and leaves of a tree. Nodes are added depth first; `close` completes it.

    `behaviors`, `objects` and `places` are each listed once: a node has their index, its code.
    `places` are those of leaves that handle no object.
    """

    def __init__(self) -> None:
        self.shape = TreeShape()
        self.names: list[str] = []
        self.behaviors: list[str] = []
        self.objects: list[str] = []
        self.places: list[str] = []
        self._parameters: list[Mapping[str, JsonValue]] = []
        self._behavior_codes = array("q")
        self._object_codes = array("q")
        self._place_codes = array("q")
        self._autonomy_ranks = array("b")
        self.declares_autonomy = False
        """Whether any leaf says what level of autonomy it needs."""
        self._known_names: set[str] = set()
        self._known_behaviors: dict[str, int] = {}
        self._known_objects: dict[str, int] = {}
        self._known_places: dict[str, int] = {}

    @classmethod
    def of(cls, definition: TaskTreeDefinition) -> "NodeTable":
        """The table of a definition."""
        table = cls()
        for node in definition.nodes:
            table.add(node)
        table.close()
        return table

    def add(self, node: GoalNode | BehaviorNode) -> None:
        """Add the next node. Raises `ValueError`: out of order, or its name occurs already."""
        if node.name in self._known_names:
            raise ValueError(f"two nodes are called '{node.name}'")
        self._known_names.add(node.name)
        self.shape.add(NodeKind(node.kind), node.parent)
        self.names.append(node.name)
        if isinstance(node, GoalNode):
            self._parameters.append(_NONE)
            for codes in (self._behavior_codes, self._object_codes, self._place_codes):
                codes.append(NO_CODE)
            self._autonomy_ranks.append(AutonomyLevel.OFF.rank)
            return
        # Made anew, item by item: the collector of garbage then never looks through a dict of plain
        # values, but it does through one that a library has made, and its copies.
        self._parameters.append({key: value for key, value in node.parameters.items()})  # noqa: C416
        self._autonomy_ranks.append(node.autonomy.rank)
        self.declares_autonomy |= node.autonomy is not AutonomyLevel.OFF
        place = node.place if node.object is None else None
        self._behavior_codes.append(_code(node.behavior, self.behaviors, self._known_behaviors))
        self._object_codes.append(_code(node.object, self.objects, self._known_objects))
        self._place_codes.append(_code(place, self.places, self._known_places))

    def object_code(self, name: str) -> int:
        """The code of an object; `NO_CODE` for one that no leaf handles."""
        return self._known_objects.get(name, NO_CODE)

    def close(self) -> None:
        """There are no more nodes. Raises `ValueError`: a goal node has no child."""
        self.shape.close()
        self._known_names.clear()

    def __len__(self) -> int:
        return len(self.names)

    def handled_objects(self) -> list[str]:
        """The object of each leaf that handles one, in tree order."""
        codes = self.object_codes
        return [self.objects[code] for code in codes[codes != NO_CODE].tolist()]

    def behavior(self, node: int) -> str | None:
        """A leaf's behavior; None for a goal node."""
        code = self._behavior_codes[node]
        return None if code == NO_CODE else self.behaviors[code]

    def autonomy_of(self, leaf: int) -> AutonomyLevel:
        """What level of autonomy a leaf needs."""
        return LEVELS[self._autonomy_ranks[leaf]]

    def text(self, node: int, parameter: str) -> str | None:
        """A leaf's parameter, if it has it and it is text; None for a goal node."""
        value = self._parameters[node].get(parameter)
        return value if isinstance(value, str) else None

    def leaf(self, node: int) -> BehaviorNode | None:
        """A leaf's definition; None for a goal node."""
        code = self._behavior_codes[node]
        if code == NO_CODE:
            return None
        return BehaviorNode(
            parent=self.shape.parents[node] if node else None,
            name=self.names[node],
            behavior=self.behaviors[code],
            parameters=dict(self._parameters[node]),
            autonomy=self.autonomy_of(node),
        )

    @property
    def autonomy_ranks(self) -> NDArray[np.int8]:
        """The rank of the level of autonomy that every node needs."""
        return np.frombuffer(self._autonomy_ranks, dtype=np.int8)

    @property
    def behavior_codes(self) -> NDArray[np.int64]:
        """Of every node; `NO_CODE` for goal nodes."""
        return np.frombuffer(self._behavior_codes, dtype=np.int64)

    @property
    def object_codes(self) -> NDArray[np.int64]:
        """Of every node; `NO_CODE` for goal nodes and for leaves without an object."""
        return np.frombuffer(self._object_codes, dtype=np.int64)

    @property
    def place_codes(self) -> NDArray[np.int64]:
        """Of every node; `NO_CODE` for all but leaves with a place and without an object."""
        return np.frombuffer(self._place_codes, dtype=np.int64)


def _code(name: str | None, listed: list[str], known: dict[str, int]) -> int:
    """The index of a name in a list, to which it is added where it is new."""
    if name is None:
        return NO_CODE
    code = known.setdefault(name, len(listed))
    if code == len(listed):
        listed.append(name)
    return code
