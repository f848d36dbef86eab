"""The state of a generator of random numbers, as text."""

import json

import numpy as np


def written_draws(rng: np.random.Generator) -> str:
    """What `read_draws` goes on from; its integers are longer than some readers of JSON take."""
    return json.dumps(rng.bit_generator.state)


def read_draws(rng: np.random.Generator, written: str) -> None:
    """Draw on from there. Raises `ValueError` for what no such generator wrote."""
    try:
        rng.bit_generator.state = json.loads(written)
    except (TypeError, KeyError) as error:
        raise ValueError(f"the snapshot's draws cannot be gone on with: {error}") from error
