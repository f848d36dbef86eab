"""Task trees written down in the compact form, for tests."""

from typing import Any

from tasks.definition import TreeDefinition, from_document


def definition_of(tree: dict[str, Any]) -> TreeDefinition:
    return from_document({"name": "tree", "tree": tree})
