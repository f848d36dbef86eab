"""Task trees written down in the compact form, for tests."""

from typing import Any

from mend.tasks.definition import TaskTreeDefinition


def definition_of(tree: dict[str, Any]) -> TaskTreeDefinition:
    """The definition of a nested tree; leaves are named after their objects if not otherwise."""
    nodes: list[dict[str, Any]] = []

    def add(node: dict[str, Any], parent: int | None) -> None:
        index = len(nodes)
        for kind in ("then", "and", "or"):
            if kind in node:
                nodes.append({"kind": kind, "parent": parent, "name": f"{kind}_{index}"})
                for child in node[kind]:
                    add(child, index)
                return
        parameters = {key: node[key] for key in node if key not in ("behavior", "name")}
        nodes.append(
            {
                "kind": "behavior",
                "parent": parent,
                "name": node.get("name", node["object"]),
                "behavior": node["behavior"],
                "parameters": parameters,
            }
        )

    add(tree, None)
    return TaskTreeDefinition.model_validate({"name": "tree", "nodes": nodes})
