"""Alternatives of one OR that do the same are counted once, and nothing else is."""

from trees import Written, and_, or_, then

from mend.tasks.alternatives import distinct_alternatives
from mend.tasks.definition import BehaviorNode, GoalNode


def nodes_of(written: Written) -> list[GoalNode | BehaviorNode]:
    """Nodes whose leaves bring what they are called to a place; names count up."""
    nodes: list[GoalNode | BehaviorNode] = []

    def add(node: Written, parent: int | None) -> None:
        index = len(nodes)
        if isinstance(node, str):
            parameters = {"object": node, "place": node}
            nodes.append(
                BehaviorNode(
                    parent=parent, name=f"n{index}", behavior="bring", parameters=parameters
                )
            )
            return
        kind, children = node
        nodes.append(GoalNode.model_validate({"kind": kind, "parent": parent, "name": f"n{index}"}))
        for child in children:
            add(child, index)

    add(written, None)
    return nodes


def test_of_equal_alternatives_the_first_is_kept_with_all_that_is_under_it() -> None:
    way = then("a", and_("b", "c"))
    nodes = nodes_of(then(or_(way, way, "d", way, "d"), "e"))
    distinct = distinct_alternatives(nodes)
    assert [node.name for node in distinct.nodes] == [nodes[i].name for i in distinct.originals]
    assert list(distinct.originals) == [0, 1, 2, 3, 4, 5, 6, 12, 19]
    assert [each.parent for each in distinct.nodes] == [None, 0, 1, 2, 2, 4, 4, 1, 0]


def test_what_differs_or_has_to_be_done_again_is_kept() -> None:
    for written in (
        or_(then("a", "b"), then("b", "a"), and_("a", "b"), "a"),
        and_("a", "a"),
        then(or_("a", "b"), or_("a", "b")),
    ):
        nodes = nodes_of(written)
        assert list(distinct_alternatives(nodes).originals) == list(range(len(nodes)))


def test_leaves_alone_are_no_alternatives() -> None:
    leaves = [each for each in nodes_of(or_("a", "a")) if isinstance(each, BehaviorNode)]
    assert distinct_alternatives(leaves).nodes == leaves
