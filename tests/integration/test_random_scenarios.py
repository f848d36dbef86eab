"""Random scenarios end, keep every constraint, and say nothing untrue at their end.

A small sample: `benchmarks/random_scenarios.py` has more of them, and larger ones.
"""

import pytest
from random_scenarios import KINDS, run_once
from sampled import sample

SEEDS = sample(range(40, 44), range(40, 46))


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
async def test_a_random_scenario_ends_and_what_it_says_is_true(seed: int) -> None:
    outcome = await run_once("tabletop", seed, most_leaves=12)
    assert outcome.wrong == []


@pytest.mark.slow
@pytest.mark.parametrize("seed", sample([203], [203, 206]))
async def test_two_robots_share_a_random_scene_and_never_touch(seed: int) -> None:
    outcome = await run_once("tabletop", seed, robots=2, most_leaves=8)
    assert outcome.wrong == []


def test_the_sample_has_every_kind_of_helper() -> None:
    assert {KINDS[seed % len(KINDS)] for seed in SEEDS} == set(KINDS)
