"""What events of steering say of a run's steering: a fold, and nothing else."""

from mend.server.journal import events as ev
from mend.tasks.steering import Hold, Steering, Word
from mend.tasks.task_tree import TaskTree


def fold_steering(steering: Steering, tree: TaskTree, event: ev.Event) -> None:
    """Apply one event, of those that are of steering; others change nothing."""
    if isinstance(event, ev.AutonomySet):
        steering.set_level(event.level)
    elif isinstance(event, ev.SteeringEvent):
        _fold_word(steering, tree.index_of(event.node), event)
    elif isinstance(event, ev.LeafHeld):
        before = None if event.breakpoint is None else tree.index_of(event.breakpoint)
        steering.wait(Hold(tree.index_of(event.node), before))


def _fold_word(steering: Steering, node: int, event: ev.SteeringEvent) -> None:
    word = Word(event.by, event.reason)
    match event:
        case ev.BreakpointSet():
            steering.set_breakpoint(node, word)
        case ev.BreakpointRemoved():
            steering.remove_breakpoint(node)
        case ev.LeafLetGo():
            steering.release(node)
        case ev.LeafPreferred():
            steering.prefer(node, word)
        case ev.LeafNotPreferred():
            steering.prefer_nothing()
