"""The eleven kinds of fault: when each happens, what a person does, what a robot may say of it."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from fault_bench import Bench, alone, width_m
from fault_judge import place_of
from fault_trial import Moment, NotNowError, Said, Trial

from mend.tasks.intervention import Act
from mend.tasks.scene import Pose

REFUSED = "refused"
_PULL_TAKES_S = 2.0
_PUSHED_M = (0.005, 0.12)
_OFF_PLACE_M = 0.01
_TRIES = 12
_TOLD_APART_M = 0.008


@dataclass(frozen=True, slots=True)
class Kind:
    """One kind of fault: `play` has it happen once, and raises `NotNowError` where it cannot.

    `names` are the issues that tell it rightly; `limit_ms` is how soon the robot has to.
    """

    play: Callable[[Bench, Trial, np.random.Generator], None]
    names: frozenset[str]
    limit_ms: float = math.inf


class Verdict(StrEnum):
    """What a trial says of the robot."""

    RIGHT = "right"
    """The first thing that it said names the fault, and was so."""
    WRONG = "wrong"
    SILENT = "silent"
    NO_EFFECT = "no effect"
    """Nothing was said, and the part was placed all the same."""
    WITHSTOOD = "withstood"
    """The fingers held on for as long as a pull may stay unnoticed."""
    BEFORE = "before"
    """Something was said before anything had happened."""


def verdict(trial: Trial) -> Verdict:
    """How the robot did; for a trial in which its fault happened."""
    kind = KINDS[trial.kind]
    assert trial.fault_s is not None, "a trial without its fault says nothing"
    if trial.said and trial.said[0].time_s < trial.fault_s:
        return Verdict.BEFORE
    if trial.kind == "pull" and _held_on_s(trial) > kind.limit_ms / 1e3:
        return Verdict.WITHSTOOD
    if trial.finished and not trial.placed:
        return Verdict.SILENT
    if not trial.said:
        return Verdict.NO_EFFECT if trial.finished else Verdict.SILENT
    first = trial.said[0]
    return Verdict.RIGHT if first.true and first.issue in kind.names else Verdict.WRONG


def latency_ms(trial: Trial) -> float:
    """From the fault to what was said first."""
    assert trial.fault_s is not None, "a trial without its fault says nothing"
    return 1e3 * (trial.said[0].time_s - trial.fault_s)


def _held_on_s(trial: Trial) -> float:
    assert trial.fault_s is not None, "a trial without its fault says nothing"
    moments = [trial.out_s] if trial.out_s is not None else []
    moments += [each.time_s for each in trial.said[:1]]
    return min(moments, default=math.inf) - trial.fault_s


# --- Taken from between the fingers ---------------------------------------------------------------


def _vanish(bench: Bench, trial: Trial, rng: np.random.Generator) -> None:
    trial.moment = _drawn(rng, (4, 5))
    bench.pick(trial, lambda: bench.act(Act.STEAL, trial.name))


def _pull(bench: Bench, trial: Trial, rng: np.random.Generator) -> None:
    trial.moment = _drawn(rng, (4, 5))
    bench.pick(trial, lambda: bench.act(Act.STEAL, trial.name, manner="pull"))


def _drop(bench: Bench, trial: Trial, rng: np.random.Generator) -> None:
    trial.moment = _drawn(rng, (4, 5))
    bench.pick(trial, bench.world.body.open_gripper)


# --- Stolen ---------------------------------------------------------------------------------------


def _stolen_before(bench: Bench, trial: Trial, rng: np.random.Generator) -> None:
    trial.moment = _drawn(rng, (0, 1, 2))
    bench.pick(trial, lambda: bench.act(Act.STEAL, trial.name))


def _stolen_while_placing(bench: Bench, trial: Trial, rng: np.random.Generator) -> None:
    trial.moment = _drawn(rng, (6, 7, 8))
    manner = "pull" if trial.moment.step == 6 and rng.random() < 0.5 else "vanish"
    trial.detail = manner
    bench.pick(trial, lambda: bench.act(Act.STEAL, trial.name, manner=manner))


def _stolen_after_done(bench: Bench, trial: Trial, rng: np.random.Generator) -> None:
    manner = str(rng.choice(["pull", "vanish"]))
    trial.detail = manner
    later_s = _PULL_TAKES_S if manner == "pull" else float(rng.uniform(0.0, 1.0))
    bench.strike_after_done(trial, lambda: bench.act(Act.STEAL, trial.name, manner=manner), later_s)


# --- Not where, or what, it was -------------------------------------------------------------------


def _swapped(bench: Bench, trial: Trial, rng: np.random.Generator) -> None:
    other = _other(bench, trial.name, rng)
    trial.moment, trial.detail = _drawn(rng, (0, 1, 2)), other
    bench.pick(trial, lambda: bench.swap(trial.name, other))


def _pushed_aside(bench: Bench, trial: Trial, rng: np.random.Generator) -> None:
    trial.moment = _drawn(rng, (0, 1, 2))
    spots = [_beside(bench, trial.name, rng) for _ in range(_TRIES)]

    def push() -> None:
        for x, y, yaw in spots:
            try:
                bench.act(Act.MOVE, trial.name, to=Pose(x=x, y=y, yaw=yaw))
            except NotNowError:
                continue
            start = bench.world.parts[trial.name].start.position
            trial.detail = f"{1e3 * math.hypot(x - start[0], y - start[1]):.0f} mm"
            return
        raise NotNowError("no room to push it to")

    bench.pick(trial, push)


def _beside(bench: Bench, name: str, rng: np.random.Generator) -> tuple[float, float, float]:
    pose = bench.world.parts[name].pose()
    far_m, angle = rng.uniform(*_PUSHED_M), rng.uniform(-math.pi, math.pi)
    turn = float(rng.uniform(-1.0, 1.0)) * float(far_m) / 0.1
    x, y, _ = pose.position
    return x + far_m * math.cos(angle), y + far_m * math.sin(angle), pose.yaw + turn


# --- In the way -----------------------------------------------------------------------------------


def _in_the_way(bench: Bench, trial: Trial, rng: np.random.Generator) -> None:
    if rng.random() < 0.5:
        trial.moment, trial.detail = _drawn(rng, range(7)), "somebody"
        bench.pick(trial, lambda: bench.act(Act.BLOCK))
        return
    other = _other(bench, trial.name, rng)
    trial.moment, trial.detail = _drawn(rng, range(6)), other
    at = bench.scene.places[place_of(trial.name)].pose
    dx, dy = (float(each) for each in rng.uniform(-_OFF_PLACE_M, _OFF_PLACE_M, 2))
    to = Pose(x=at.x + dx, y=at.y + dy, yaw=float(rng.uniform(-math.pi, math.pi)))
    bench.pick(trial, lambda: bench.act(Act.MOVE, other, to=to))


def _camera_covered(bench: Bench, trial: Trial, rng: np.random.Generator) -> None:
    trial.moment = _drawn(rng, range(9))
    bench.pick(trial, lambda: bench.act(Act.COVER))


# --- Handed over ----------------------------------------------------------------------------------


def _wrong_hand_over(bench: Bench, trial: Trial, rng: np.random.Generator) -> None:
    other = _other(bench, trial.name, rng)
    trial.detail, trial.fault_s = other, bench.robot.time_s()
    took_wrong = bench.take(trial.name, other)
    bench.act(Act.PUT_BACK, other)
    if took_wrong:
        trial.finished = True
        return
    now_s = bench.robot.time_s()
    if not bench.take(trial.name, trial.name):
        trial.said.append(Said("refused the right one too", now_s, "", true=False))
        return
    trial.said.append(Said(REFUSED, now_s, "", true=True))


def _other(bench: Bench, name: str, rng: np.random.Generator) -> str:
    """Another part, one that the fingers or a forearm camera can tell from this one."""
    mine = bench.scene.objects[name]
    others = []
    for each in alone(bench):
        its = bench.scene.objects[each]
        as_wide = abs(width_m(bench, name) - width_m(bench, each)) < _TOLD_APART_M
        same = as_wide and np.allclose(mine.color, its.color, atol=0.15)
        if each not in bench.judge.alike[name] and not same:
            others.append(each)
    if not others:
        raise NotNowError("there is no part that is unlike it")
    return str(rng.choice(others))


def _drawn(rng: np.random.Generator, steps: Sequence[int]) -> Moment:
    step = int(rng.choice(list(steps)))
    return Moment(step, 0.0 if step == 0 else float(rng.uniform(0.05, 0.9)))


KINDS = {
    "vanish": Kind(_vanish, frozenset({"dropped"}), 150.0),
    "pull": Kind(_pull, frozenset({"dropped"}), 800.0),
    "drop": Kind(_drop, frozenset({"dropped"}), 300.0),
    "stolen before": Kind(_stolen_before, frozenset({"missing", "missed"})),
    "stolen while placing": Kind(_stolen_while_placing, frozenset({"dropped", "undone"})),
    "stolen after done": Kind(_stolen_after_done, frozenset({"undone"})),
    "swapped": Kind(_swapped, frozenset({"missing", "missed"})),
    "pushed aside": Kind(_pushed_aside, frozenset({"missed", "unreachable", "undone"})),
    # A known part at the place leaves no room there, which is as true and names it.
    "in the way": Kind(_in_the_way, frozenset({"blocked", "unreachable"})),
    "camera covered": Kind(_camera_covered, frozenset({"blind"})),
    "wrong hand-over": Kind(_wrong_hand_over, frozenset({REFUSED})),
}
