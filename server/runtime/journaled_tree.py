"""The task tree of a `run_started` event, read node by node: a large one holds nobody up.

The text of such an event has the tree after fields that hold no other object.
"""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from pydantic import TypeAdapter

from mend.server.journal import events as ev
from mend.server.journal.stored_event import UnreadableEventError, read_event
from mend.server.journal.subscriptions import Record
from mend.server.turns import Turns
from mend.tasks.definition import BehaviorNode, GoalNode, NodeDefinition
from mend.tasks.node_table import NodeTable

_BEGIN = '"tree":'
_SPACE = " \t\r\n"

_decoder = json.JSONDecoder()
_node: TypeAdapter[GoalNode | BehaviorNode] = TypeAdapter(NodeDefinition)


async def read_nodes(text: str, begin: int = 0) -> NodeTable:
    """The nodes of a definition that is JSON. Raises `ValueError` where it is none."""
    return (await _nodes_at(text, begin))[0]


async def read_started(record: Record) -> tuple[ev.Event, NodeTable | None]:
    """A run's first event, and the nodes of its tree, which is left empty in the event.

    They are None for an event that is not `run_started`. Raises `UnreadableEventError`.
    """
    begin = _begin_of_tree(record.text)
    if begin is None:
        return read_event(record.seq, record.text), None
    with _told_of(record.seq):
        nodes, end = await _nodes_at(record.text, begin)
    return _without_tree(record, begin, end), nodes


async def read_without_tree(record: Record) -> ev.Event:
    """Any event; the tree of a run's first one is passed over, and left empty.

    Raises `UnreadableEventError`.
    """
    begin = _begin_of_tree(record.text)
    if begin is None:
        return read_event(record.seq, record.text)
    with _told_of(record.seq):
        end = await _read_tree(record.text, begin, lambda _: None)
    return _without_tree(record, begin, end)


def _begin_of_tree(text: str) -> int | None:
    """Where the tree of a `run_started` event begins; None in every other event."""
    begin = text.find(_BEGIN)
    if begin < 0 or '"type":"run_started"' not in text[:begin]:
        return None
    return begin + len(_BEGIN)


@contextmanager
def _told_of(seq: int) -> Iterator[None]:
    """Raises `UnreadableEventError` for what a text trips over that is no tree."""
    try:
        yield
    except (ValueError, RecursionError) as error:
        first = str(error).splitlines()[0]
        raise UnreadableEventError(
            f"event {seq} cannot be read: its tree is none: {first}"
        ) from error


def _without_tree(record: Record, begin: int, end: int) -> ev.Event:
    return read_event(record.seq, f"{record.text[:begin]}{{}}{record.text[end:]}")


async def _nodes_at(text: str, begin: int) -> tuple[NodeTable, int]:
    """The nodes of the object at `begin`, and where the object ends."""
    nodes = NodeTable()
    end = await _read_tree(text, begin, lambda node: nodes.add(_node.validate_python(node)))
    if len(nodes) == 0:
        raise ValueError("it has no 'nodes'")
    nodes.close()
    return nodes, end


async def _read_tree(text: str, begin: int, take: Callable[[Any], None]) -> int:
    """Hand on each node of the object at `begin`; returns where the object ends."""
    at = _skip(text, _expect(text, begin, "{"))
    while text[at : at + 1] != "}":
        key, at = _value(text, at)
        at = _expect(text, at, ":")
        if key == "nodes":
            at = await _read_list(text, at, take)
        else:
            _, at = _value(text, at)
        at = _after(text, at, "}")
    return at + 1


async def _read_list(text: str, begin: int, take: Callable[[Any], None]) -> int:
    turns = Turns()
    at = _skip(text, _expect(text, begin, "["))
    while text[at : at + 1] != "]":
        value, at = _value(text, at)
        take(value)
        at = _after(text, at, "]")
        await turns.pass_on()
    return at + 1


def _after(text: str, at: int, end: str) -> int:
    """Where the next member begins, or the end of all of them stands."""
    at = _skip(text, at)
    if text[at : at + 1] == end:
        return at
    at = _skip(text, _expect(text, at, ","))
    if text[at : at + 1] == end:
        raise ValueError(f"something more was expected at character {at}")
    return at


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
