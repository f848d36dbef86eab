"""Reads a run's events and says which constraint they broke, if any.

It knows nothing of the task tree's code: it works from the kinds of the nodes and the paths alone,
so that it can find fault with both the tree and the runtime.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from uuid import UUID

from mend.server.journal import events as ev


def broken_constraints(events: Sequence[ev.Event], kinds: Mapping[str, str]) -> list[str]:
    """One sentence per broken constraint of one run; `kinds` has every node's kind by its path."""
    return _Reader(kinds).read(events)


class _Reader:
    def __init__(self, kinds: Mapping[str, str]) -> None:
        self._kinds = kinds
        self._children: dict[str, list[str]] = {path: [] for path in kinds}
        for path in kinds:
            if path != "/":
                self._children[_parent(path)].append(path)
        for siblings in self._children.values():
            siblings.sort(key=lambda path: int(path.rsplit("/", 1)[1]))
        self._done: set[str] = set()
        self._active: dict[str, str | None] = {}
        self._abandoned: set[str] = set()
        self._left_out: dict[str, str] = {}
        self._said_last: dict[str, str] = {}
        self._open: dict[UUID, str] = {}
        self._answered: Counter[UUID] = Counter()
        self._word = _Word()
        self._broken: list[str] = []
        self._ended: str | None = None

    def read(self, events: Sequence[ev.Event]) -> list[str]:
        last_seq, last_time = 0, 0.0
        for event in events:
            if event.seq <= last_seq:
                self._breach(event, f"comes after event {last_seq}")
            if event.time < last_time:
                self._breach(event, f"goes back in time, from {last_time}")
            if self._ended:
                self._breach(event, f"comes after the run has ended with {self._ended}")
            last_seq, last_time = event.seq, max(last_time, event.time)
            self._take(event)
        return self._broken

    def _breach(self, event: ev.Event, sentence: str) -> None:
        self._broken.append(f"event {event.seq} ({getattr(event, 'type', '?')}) {sentence}")

    def _take(self, event: ev.Event) -> None:
        self._word.take(event)
        match event:
            case ev.LeafTriedAgain():
                self._try_again(event)
            case ev.NodeLeftOut(robot=None):
                self._begin(event, event.helper)
                self._said_last[event.node] = event.helper
                self._leave_out(event)
            case ev.NodeStarted():
                self._started(event)
            case ev.NodeTaken():
                self._begin(event, event.helper)
            case ev.NodeDone():
                self._finish(event)
            case ev.NodeLeftOut():
                self._leave_out(event)
            case ev.NodeReturned():
                if self._left_out.pop(event.node, None) is None:
                    self._breach(event, f"finds {event.node} again, which was not left out")
            case ev.NodeUndone():
                self._undo(event)
            case ev.NodeReset():
                if event.node not in self._active:
                    self._breach(event, f"puts back {event.node}, which is not active")
                self._active.pop(event.node, None)
            case ev.NodeAbandoned():
                self._abandon(event)
            case ev.DialogueOpened():
                self._open[event.dialogue] = event.node
            case ev.DialogueClosed():
                if self._open.pop(event.dialogue, None) is None:
                    self._breach(event, "closes a dialogue that is not open")
            case ev.Answered():
                self._said_last[event.node] = event.helper
                self._answered[event.prompt] += 1
                if self._answered[event.prompt] > 1:
                    self._breach(event, f"answers prompt {event.prompt} a second time")
            case ev.RunFinished():
                self._finish_run(event)
            case ev.RunFailed():
                self._end(event, "run_failed")
            case ev.RunAborted():
                self._end(event, "run_aborted")

    def _finish(self, event: ev.NodeDone | ev.NodeLeftOut) -> None:
        if event.node not in self._active:
            self._breach(event, f"finishes {event.node}, which is not active")
        self._active.pop(event.node, None)
        self._done.add(event.node)

    def _leave_out(self, event: ev.NodeLeftOut) -> None:
        self._finish(event)
        self._left_out[event.node] = event.helper
        if self._said_last.get(event.node) != event.helper:
            self._breach(event, f"leaves {event.node} out, which {event.helper} did not say")

    def _undo(self, event: ev.NodeUndone) -> None:
        if event.node not in self._done:
            self._breach(event, f"takes back {event.node}, which is not done")
        for later in self._after(event.node):
            if self._is_touched(later):
                self._breach(event, f"takes back {event.node} before {later}, which comes after it")
        if event.because_of is not None and not any(
            event.node == later or event.node.startswith(later + "/")
            for later in self._after(event.because_of)
        ):
            self._breach(event, f"takes back {event.node}, which needs no {event.because_of}")
        self._done.discard(event.node)
        self._left_out.pop(event.node, None)

    def _try_again(self, event: ev.LeafTriedAgain) -> None:
        node = event.node
        if node in self._active:
            self._breach(event, f"has {node} tried again, which is active")
        if node in self._done and node not in self._left_out:
            self._breach(event, f"has {node} tried again, which is done")
        for later in self._after(node):
            if self._is_touched(later):
                self._breach(event, f"has {node} tried again after {later} has begun")
        self._done.discard(node)
        self._left_out.pop(node, None)
        self._abandoned -= {each for each in self._abandoned if _is_at_or_under(node, each)}

    def _after(self, node: str) -> list[str]:
        """The nodes that a THEN puts after one, as children of THENs above it."""
        found, child = [], node
        while child != "/":
            parent = _parent(child)
            if self._kinds[parent] == "then":
                siblings = self._children[parent]
                found += siblings[siblings.index(child) + 1 :]
            child = parent
        return found

    def _finish_run(self, event: ev.RunFinished) -> None:
        if not self._is_done("/"):
            self._breach(event, "finishes a task that is not done")
        for part in event.missing:
            if part.left_out_by is None or self._left_out.get(part.node) != part.left_out_by:
                self._breach(event, f"finishes without {part.node}, which nobody left out")
        told = {part.node for part in event.missing}
        for node in self._left_out.keys() - told:
            self._breach(event, f"does not tell that {node} was left out")
        self._end(event, "run_finished")

    def _end(self, event: ev.Event, kind: str) -> None:
        self._ended = kind
        if self._open:
            self._breach(event, f"leaves {len(self._open)} dialogues open")

    def _started(self, event: ev.NodeStarted) -> None:
        if event.robot in self._active.values():
            self._breach(event, f"gives {event.robot} a second leaf")
        for why in self._word.against(event, self._is_touched):
            self._breach(event, f"starts {event.node}, though {why}")
        self._word.begun(event.node)
        self._begin(event, event.robot)

    def _begin(self, event: ev.NodeStarted | ev.NodeTaken | ev.NodeLeftOut, owner: str) -> None:
        node = event.node
        if node in self._done or node in self._active:
            self._breach(event, f"starts {node}, which is active or done")
        if node in self._open.values():
            self._breach(event, f"starts {node} while there is a dialogue about it")
        child = node
        while child != "/":
            parent = _parent(child)
            if self._is_done(parent):
                self._breach(event, f"starts {node}, though {parent} is done")
            if child in self._abandoned:
                self._breach(event, f"starts {node} under the abandoned {child}")
            self._check_siblings(event, parent, child)
            child = parent
        self._active[node] = owner

    def _check_siblings(
        self,
        event: ev.NodeStarted | ev.NodeTaken | ev.NodeLeftOut,
        parent: str,
        child: str,
    ) -> None:
        siblings = self._children[parent]
        if self._kinds[parent] == "then":
            for earlier in siblings[: siblings.index(child)]:
                if not self._is_done(earlier):
                    self._breach(event, f"starts {event.node} before {earlier} is done")
        if self._kinds[parent] == "or":
            for other in siblings:
                if other != child and self._is_touched(other):
                    self._breach(event, f"starts {event.node}, though {parent} took {other}")

    def _abandon(self, event: ev.NodeAbandoned) -> None:
        if self._is_touched(event.node):
            self._breach(event, f"abandons {event.node}, under which something is active or done")
        if event.node == "/" or self._kinds[_parent(event.node)] != "or":
            self._breach(event, f"abandons {event.node}, which is no alternative of an OR")
        self._abandoned.add(event.node)

    def _is_touched(self, node: str) -> bool:
        prefix = node.rstrip("/") + "/"
        return any(each == node or each.startswith(prefix) for each in (*self._active, *self._done))

    def _is_done(self, node: str) -> bool:
        kind = self._kinds[node]
        if kind == "behavior":
            return node in self._done
        children = (self._is_done(each) for each in self._children[node])
        return any(children) if kind == "or" else all(children)


class _Word:
    """What people have said of a run: where it is to wait, and how much it may do alone."""

    def __init__(self) -> None:
        self._level = "full"
        self._breakpoints: set[str] = set()
        self._let_go: set[str] = set()

    def take(self, event: ev.Event) -> None:
        match event:
            case ev.RunStarted():
                self._level = str(event.options.get("autonomy", "full"))
            case ev.AutonomySet():
                self._level = str(event.level)
            case ev.BreakpointSet():
                self._breakpoints.add(event.node)
                self._let_go -= {n for n in self._let_go if _is_at_or_under(n, event.node)}
            case ev.BreakpointRemoved():
                self._breakpoints.discard(event.node)
            case ev.LeafLetGo():
                self._let_go.add(event.node)
            case ev.NodeTaken() | ev.NodeLeftOut(robot=None):
                self.begun(event.node)

    def begun(self, node: str) -> None:
        self._let_go.discard(node)

    def against(self, event: ev.NodeStarted, is_touched: Callable[[str], bool]) -> Iterator[str]:
        """Why a robot must not begin a leaf by itself."""
        if event.node in self._let_go:
            return
        for each in self._breakpoints:
            if _is_at_or_under(event.node, each) and not is_touched(each):
                yield f"there is a breakpoint before {each}"
        if self._level == "off" or (self._level == "low" and event.attempt > 1):
            yield f"with autonomy {self._level} it has to ask"


def _is_at_or_under(node: str, top: str) -> bool:
    return node == top or node.startswith(top.rstrip("/") + "/")


def _parent(path: str) -> str:
    return path.rsplit("/", 1)[0] or "/"
