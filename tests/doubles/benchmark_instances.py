"""Where the published benchmark instances are, if they are here; they are not the product's."""

import os
from pathlib import Path

DATA = Path(os.environ.get("BENCH_DATA", Path(__file__).parents[3] / "shared/data")) / "scheduling"
