"""The definition of a task tree: checked, immutable, and kept in the journal in its JSON form.

The nodes stand in one flat list, depth first, each with the index of its parent, so that neither
reading nor writing a deep tree needs recursion.
"""

from collections.abc import Sequence
from enum import StrEnum
from typing import Annotated, Any, Literal, Self

from pydantic import Field, JsonValue, model_validator

from mend.documents.strict_model import StrictModel
from mend.tasks.autonomy import AutonomyLevel
from mend.tasks.scene import Name


class NodeKind(StrEnum):
    """The kinds of node: three goal nodes and the behavior node (leaf)."""

    THEN = "then"
    """All children, in order."""
    AND = "and"
    """All children, in any order."""
    OR = "or"
    """Exactly one child."""
    BEHAVIOR = "behavior"
    """A leaf: an agent carries out a behavior."""


class GoalNode(StrictModel):
    """A node with children. `parent` is an index into the definition's nodes, None for the root."""

    kind: Literal["then", "and", "or"]
    parent: Annotated[int, Field(ge=0)] | None
    name: Name


def _is_usual(needed: AutonomyLevel) -> bool:
    return needed is AutonomyLevel.OFF


class BehaviorNode(StrictModel):
    """A leaf: a behavior and its checked parameters.

    `autonomy`: what level a run needs more than to begin it by itself.
    """

    kind: Literal["behavior"] = "behavior"
    parent: Annotated[int, Field(ge=0)] | None
    name: Name
    behavior: str
    parameters: dict[str, JsonValue] = {}
    autonomy: Annotated[AutonomyLevel, Field(strict=False, exclude_if=_is_usual)] = (
        AutonomyLevel.OFF
    )

    @property
    def object(self) -> str | None:
        """The object that the behavior handles, if it handles one."""
        return self._text("object")

    @property
    def place(self) -> str | None:
        """The place that the behavior fills, if it fills one."""
        return self._text("place")

    @property
    def item(self) -> str | None:
        """What the behavior carries for people, if it carries anything."""
        return self._text("item")

    @property
    def held_by(self) -> str | None:
        """In the basket of which robot it is what the behavior is to get, if it is in one."""
        return self._text("held_by")

    @property
    def away_m(self) -> float | None:
        """How far from the leaf's place that robot stands, where that is known."""
        value = self.parameters.get("away_m")
        return float(value) if isinstance(value, int | float) else None

    @property
    def message(self) -> str | None:
        """What the behavior tells people, if it tells anything."""
        return self._text("message")

    @property
    def person(self) -> str | None:
        """Whom the behavior meets or escorts, if anybody."""
        return self._text("person")

    @property
    def entrusted(self) -> str | None:
        """What, or whom, one robot has with it from one leaf to the next."""
        return self.item or self.person

    @property
    def needs_help(self) -> bool:
        """Whether a helper has to lend a hand at the end of the behavior."""
        return self.parameters.get("needs_help") is True

    def _text(self, parameter: str) -> str | None:
        value = self.parameters.get(parameter)
        return value if isinstance(value, str) else None


NodeDefinition = Annotated[GoalNode | BehaviorNode, Field(discriminator="kind")]


class TaskTreeDefinition(StrictModel):
    """A whole task tree. `scene` is the name of the scene it is for, None for any.

    Node 0 is the root, every other node comes after its parent and its parent's earlier children
    with all that is under them; every goal node has a child and every name occurs once.
    """

    name: Name
    description: str = ""
    scene: Name | None = None
    nodes: Annotated[list[NodeDefinition], Field(min_length=1)]

    @model_validator(mode="after")
    def _check_structure(self) -> Self:
        _require_depth_first(self.nodes)
        _require_unique_names(self.nodes)
        return self

    def to_json(self) -> dict[str, Any]:
        """The JSON form, which `model_validate` reads back."""
        return self.model_dump(mode="json")


def _require_depth_first(nodes: Sequence[GoalNode | BehaviorNode]) -> None:
    """Raise ValueError unless the nodes form one tree in depth-first order."""
    if nodes[0].parent is not None:
        raise ValueError("node 0 is the root and must not have a parent")
    open_goals: list[int] = []
    for index, node in enumerate(nodes):
        if index > 0:
            while open_goals and open_goals[-1] != node.parent:
                open_goals.pop()
            if not open_goals:
                raise ValueError(
                    f"node {index} ('{node.name}') must follow its parent in depth-first order, "
                    f"but its parent is {node.parent}"
                )
        if isinstance(node, GoalNode):
            if index + 1 == len(nodes) or nodes[index + 1].parent != index:
                raise ValueError(f"goal node {index} ('{node.name}') must have a child")
            open_goals.append(index)


def _require_unique_names(nodes: Sequence[GoalNode | BehaviorNode]) -> None:
    """Raise ValueError if two nodes have one name."""
    seen: dict[str, int] = {}
    for index, node in enumerate(nodes):
        if node.name in seen:
            raise ValueError(f"nodes {seen[node.name]} and {index} are both called '{node.name}'")
        seen[node.name] = index
