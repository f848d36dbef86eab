"""The events of a run that people steer at random, to hold other folds of them against."""

from collections.abc import Sequence
from random import Random

from full_evaluation import random_tree
from steered_run import ROBOTS, SteeredRun, started

from mend.server.journal import events as ev
from mend.server.runtime.steering_views import SetAutonomy, SteerNode
from mend.tasks.autonomy import AutonomyLevel
from mend.tasks.steering_rules import SteeringAct

LEAVES = 10
STEPS = 400


def steered_events(seed: int) -> Sequence[ev.Event]:
    """What people say, what robots do, and before what they wait."""
    random = Random(seed)
    run = SteeredRun(started(random_tree(LEAVES, random), [AutonomyLevel.OFF], AutonomyLevel.FULL))
    for _ in range(STEPS):
        step = random.choice([_steer, _steer, _set_level, _start, _wait, _end, _gone, _pause])
        step(run, random)
    return run.events


def _steer(run: SteeredRun, random: Random) -> None:
    node = run.state.tree.path_of(random.randrange(len(run.state.tree)))
    if offered := run.steering.offers(node).offered:
        often = [1 if each.act is SteeringAct.SET_BREAKPOINT else 5 for each in offered]
        (act,) = (each.act for each in random.choices(offered, often))
        run.steer(SteerNode.model_validate({"act": str(act), "node": node}))


def _set_level(run: SteeredRun, random: Random) -> None:
    level = random.choice(list(AutonomyLevel))
    if random.random() < 0.2 and level is not run.state.steering.level:
        run.steer(SetAutonomy(act="set_autonomy", level=level))


def _start(run: SteeredRun, random: Random) -> None:
    idle = [each for each in ROBOTS if each not in run.state.executions]
    if idle and (startable := run.startable()):
        run.start(random.choice(startable), idle[0])


def _wait(run: SteeredRun, random: Random) -> None:
    state = run.state
    found = (
        state.steering.hold_on(int(each), state.taken_back) for each in state.tree.eligible_leaves()
    )
    held = [each for each in found if each is not None]
    if held:
        run.happens(run.steering.held(random.choice(held), ROBOTS[0]))


def _end(run: SteeredRun, random: Random) -> None:
    if active := run.state.tree.active_leaves():
        leaf = random.choice(active)
        if random.random() < 0.5:
            run.finish(leaf)
        else:
            run.put_back(leaf, failed=random.random() < 0.5)
    if (tired := run.exhausted()) and random.random() < 0.5:
        run.give_up(tired[0])


def _gone(run: SteeredRun, random: Random) -> None:
    state = run.state
    done = [leaf for leaf in state.tree.leaves if state.tree.done(leaf)]
    done = [leaf for leaf in done if leaf not in state.left_out]
    if done and random.random() < 0.5:
        run.gone(random.choice(done))


def _pause(run: SteeredRun, random: Random) -> None:
    if random.random() < 0.2:
        run.happens(ev.RunPaused(**run.stamp()))
        run.happens(ev.RunResumed(**run.stamp()))
