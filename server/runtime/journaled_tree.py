"""The task tree of a `run_started` event, read node by node: a large one holds nobody up.

The text of such an event has the tree after fields that hold no other object.
"""

import json
from typing import Any

from pydantic import TypeAdapter

from server.journal import events as ev
from server.journal.stored_event import UnreadableEventError, read_event
from server.journal.subscriptions import Record
from server.turns import Turns
from tasks.definition import BehaviorNode, GoalNode, NodeDefinition
from tasks.node_table import NodeTable

_BEGIN = '"tree":'
_SPACE = " \t\r\n"

_decoder = json.JSONDecoder()
_node: TypeAdapter[GoalNode | BehaviorNode] = TypeAdapter(NodeDefinition)


async def read_nodes(text: str, begin: int = 0) -> NodeTable:
    """The nodes of a definition that is JSON. Raises `ValueError` where it is none."""
    return (await _read_tree(text, begin))[0]


async def read_started(record: Record) -> tuple[ev.Event, NodeTable | None]:
    """A run's first event, and the nodes of its tree, which is left empty in the event.

    They are None for an event that is not `run_started`. Raises `UnreadableEventError`.
    """
    begin = record.text.find(_BEGIN)
    if begin < 0 or '"type":"run_started"' not in record.text[:begin]:
        return read_event(record.seq, record.text), None
    begin += len(_BEGIN)
    try:
        nodes, end = await _read_tree(record.text, begin)
    except (ValueError, RecursionError) as error:
        first = str(error).splitlines()[0]
        raise UnreadableEventError(
            f"event {record.seq} cannot be read: its tree is none: {first}"
        ) from error
    return read_event(record.seq, f"{record.text[:begin]}{{}}{record.text[end:]}"), nodes


async def _read_tree(text: str, begin: int) -> tuple[NodeTable, int]:
    """The nodes of the object at `begin`, and where the object ends."""
    nodes: NodeTable | None = None
    at = _expect(text, begin, "{")
    while True:
        key, at = _value(text, at)
        at = _expect(text, at, ":")
        if key == "nodes":
            nodes, at = await _read_list(text, at)
        else:
            _, at = _value(text, at)
        at = _skip(text, at)
        if text[at : at + 1] == "}":
            break
        at = _expect(text, at, ",")
    if nodes is None:
        raise ValueError("it has no 'nodes'")
    return nodes, at + 1


async def _read_list(text: str, begin: int) -> tuple[NodeTable, int]:
    nodes, turns = NodeTable(), Turns()
    at = _expect(text, begin, "[")
    while True:
        value, at = _value(text, at)
        nodes.add(_node.validate_python(value))
        at = _skip(text, at)
        if text[at : at + 1] == "]":
            break
        at = _expect(text, at, ",")
        await turns.pass_on()
    nodes.close()
    return nodes, at + 1


def _value(text: str, at: int) -> tuple[Any, int]:
    return _decoder.raw_decode(text, _skip(text, at))


def _skip(text: str, at: int) -> int:
    while text[at : at + 1] in _SPACE and at < len(text):
        at += 1
    return at


def _expect(text: str, at: int, what: str) -> int:
    """Where the text goes on after a character that must come next."""
    at = _skip(text, at)
    if text[at : at + 1] != what:
        raise ValueError(f"'{what}' was expected at character {at}")
    return at + 1
