"""False alarms in clean picks, and eleven kinds of fault, over random scenes in the workcell.

    python benchmarks/faults.py [--picks 1000] [--faults 1000] [--seed 1] [--quick]
    python benchmarks/faults.py --seed 5000 --picks 0 --faults 100 --keep more.jsonl
    python benchmarks/faults.py --show some.jsonl more.jsonl
    python benchmarks/faults.py --replay 105000 --first vanish [--pictures FOLDER]

Parts are drawn over all that the gripper fits, dark, grey and equal ones too. Pictures and depth
have noise, light and exposure change. Every issue is judged by the simulated world the moment it
is told; what is said first after a fault has to be true and to name that fault. Latencies are
simulated time from when the fault began; "out" is from when the fingers really held the part no
more. What nobody could notice is counted apart: a pull that the fingers withstand for longer than
the limit, and what kept nothing from being placed. Beside the robot's own watch a plain one looks
at the same forearm pictures: it expects the blob of the part's colours where it was in the image
when the gripper closed.
"""

# ruff: noqa: T201

import argparse
import json
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
from fault_bench import Bench, alone, benches, width_m
from fault_kinds import KINDS, Verdict, latency_ms, verdict
from fault_replay import told
from fault_trial import Moment, NotNowError, Said, Trial

CLEAN = "clean"
FAULTS_FROM = 100_000
"""Faults are drawn in the scenes of seeds so much higher than those of the clean picks."""


def clean_picks(of: Iterator[Bench], count: int, narrowest_m: float) -> Iterator[Trial]:
    """Parts placed without any fault."""
    made = 0
    for bench in of:
        for name in _drawn_from(bench, narrowest_m):
            if made == count:
                return
            made += 1
            trial = Trial(bench.seed, name, CLEAN)
            bench.pick(trial, _nothing)
            yield trial


def _nothing() -> None:
    """No fault."""


def faulty_picks(
    of: Iterator[Bench], count: int, kinds: Sequence[str], narrowest_m: float
) -> Iterator[Trial]:
    """Parts that each meet one fault, by turns of every kind; each scene is tidied in between."""
    made = 0
    for bench in of:
        rng = np.random.default_rng([bench.seed, 1])
        for name in _drawn_from(bench, narrowest_m):
            if made == count:
                return
            trial = Trial(bench.seed, name, kinds[made % len(kinds)])
            try:
                KINDS[trial.kind].play(bench, trial, rng)
            except NotNowError:
                trial.fault_s = None
            if trial.fault_s is not None:
                made += 1
                yield trial
            if not bench.clear_up():
                break


def _drawn_from(bench: Bench, narrowest_m: float) -> list[str]:
    return [name for name in alone(bench) if width_m(bench, name) >= narrowest_m]


# --- Reports --------------------------------------------------------------------------------------


def report_clean(trials: Sequence[Trial]) -> None:
    said = [(trial, each) for trial in trials for each in trial.said]
    false = sum(not each.true for _, each in said)
    plain = sum(each.plain_s is not None for each in trials)
    placed = sum(each.placed for each in trials)
    print(f"clean picks {len(trials)}, placed {placed}")
    print(f"  issues: {dict(Counter(each.issue for _, each in said)) or 'none'}")
    print(f"  false alarms: {false}; {1e3 * false / max(len(trials), 1):.1f} per 1,000 picks")
    print(f"  plain watch: {plain} false alarms; ratio {plain / max(false, 1):.0f}")
    for trial, each in said:
        print(f"    {_told(trial, each)}")
    for trial in trials:
        if not trial.said and not trial.placed:
            print(f"    {trial.seed} {trial.name}: SILENT, not placed")


def report_faults(trials: Sequence[Trial]) -> None:
    head = [*(str(each) for each in Verdict), "late", "p50 ms", "p90 ms", "max ms", "limit"]
    columns = [*head, "out p50", "out max", "plain"]
    print(f"faults {len(trials)}")
    print(f"  {'kind':21}{'n':>5}" + "".join(f"{each:>10}" for each in columns))
    for kind in KINDS:
        _report_kind(kind, [each for each in trials if each.kind == kind])
    counts = Counter(verdict(each) for each in trials)
    told = counts[Verdict.RIGHT] + counts[Verdict.WRONG] + counts[Verdict.SILENT]
    print(
        f"  of {told} that could be noticed: {counts[Verdict.RIGHT]} rightly named, "
        f"{counts[Verdict.WRONG]} said wrongly, {counts[Verdict.SILENT]} silent"
    )
    for trial in trials:
        how = verdict(trial)
        if how in (Verdict.WRONG, Verdict.SILENT, Verdict.BEFORE) or _is_late(trial):
            said = "; ".join(_told(trial, each) for each in trial.said) or "nothing"
            print(f"    {how} {trial.kind} ({_moment(trial)} {trial.detail}): {said or trial}")


def _report_kind(kind: str, trials: Sequence[Trial]) -> None:
    verdicts = Counter(verdict(each) for each in trials)
    right = [each for each in trials if verdict(each) is Verdict.RIGHT]
    p50, p90, worst = np.percentile([latency_ms(e) for e in right] or [np.nan], [50, 90, 100])
    after_ms = [1e3 * (e.said[0].time_s - e.out_s) for e in right if e.out_s is not None]
    out_p50, out_max = np.percentile(after_ms or [np.nan], [50, 100])
    late = sum(_is_late(each) for each in trials)
    plain = sum(each.plain_s is not None for each in trials)
    counts = "".join(f"{verdicts[each]:10}" for each in Verdict)
    times = "".join(
        f"{each:10.0f}" for each in (p50, p90, worst, KINDS[kind].limit_ms, out_p50, out_max)
    )
    print(f"  {kind:21}{len(trials):5}{counts}{late:10}{times}{plain:10}")


def _is_late(trial: Trial) -> bool:
    return verdict(trial) is Verdict.RIGHT and latency_ms(trial) > KINDS[trial.kind].limit_ms


def _moment(trial: Trial) -> str:
    return f"seed {trial.seed} {trial.name} step {trial.moment.step} {trial.moment.fraction:.2f}"


def _told(trial: Trial, said: Said) -> str:
    so = "true" if said.true else "FALSE"
    return f"{trial.seed} {trial.name}: {said.issue} ({so}) {said.why}"


# --- Pieces ---------------------------------------------------------------------------------------


def read(path: Path) -> Iterator[Trial]:
    """The trials that an earlier run kept."""
    for line in path.read_text(encoding="utf-8").splitlines():
        raw = json.loads(line)
        raw["moment"] = Moment(*raw["moment"])
        raw["said"] = [Said(**each) for each in raw["said"]]
        yield Trial(**raw)


def report(trials: Sequence[Trial]) -> None:
    clean = [each for each in trials if each.kind == CLEAN]
    faulty = [each for each in trials if each.kind != CLEAN]
    if clean:
        report_clean(clean)
    if faulty:
        report_faults(faulty)


def _measure(given: argparse.Namespace) -> Iterator[Trial]:
    picks, faults = (6, len(KINDS)) if given.quick else (given.picks, given.faults)
    look = given.noise, given.light
    yield from clean_picks(benches(given.seed, *look), picks, given.narrowest)
    kinds = given.kind or list(KINDS)
    of = benches(given.seed + FAULTS_FROM, *look)
    yield from faulty_picks(of, faults, kinds, given.narrowest)


def replay(given: argparse.Namespace) -> None:
    """The faults of one scene, of which the first was of the kind `given.first`."""
    kinds = list(KINDS)
    begin = kinds.index(given.first)
    of = told(benches(given.replay, given.noise, given.light), given.pictures)
    for trial in faulty_picks(of, 1000, kinds[begin:] + kinds[:begin], given.narrowest):
        print(f"{verdict(trial)}: {trial}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--picks", type=int, default=1000)
    parser.add_argument("--faults", type=int, default=1000)
    parser.add_argument("--kind", action="append", choices=list(KINDS), help="only of these kinds")
    parser.add_argument("--noise", type=float, default=4.0, help="grey levels of 255")
    parser.add_argument("--light", type=float, default=1.0, help="how much light varies, 0 to 1")
    parser.add_argument("--narrowest", type=float, default=0.0, help="m between the fingers")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="add what is found to this file")
    parser.add_argument("--show", type=Path, nargs="+", help="report what was kept in these")
    parser.add_argument(
        "--replay", type=int, help="tell all that happens in the scene of this seed"
    )
    parser.add_argument("--first", choices=list(KINDS), default="vanish", help="fault of a replay")
    parser.add_argument("--pictures", type=Path, help="keep the pictures of a replay here")
    parser.add_argument("--quick", action="store_true", help="6 picks and one fault of each kind")
    given = parser.parse_args()
    if given.show:
        report([trial for path in given.show for trial in read(path)])
        return
    if given.replay is not None:
        replay(given)
        return
    print(f"camera noise {given.noise:g} grey levels, light varies by {given.light:g}")
    begin = time.perf_counter()
    trials = []
    for trial in _measure(given):
        trials.append(trial)
        if given.keep:
            with given.keep.open("a", encoding="utf-8") as file:
                print(json.dumps(asdict(trial)), file=file)
    report(trials)
    print(f"  ({time.perf_counter() - begin:.0f} s)")


if __name__ == "__main__":
    main()
