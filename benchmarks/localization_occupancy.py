"""What lines out of an occupancy picture cost: every real log on its vector map, and on that map
drawn as Nav2 has it (cells of 5 cm, hits 1.5 cm off) and read back.

A log NAME-corrected.log.gz belongs to the map NAME.vectormap.txt; logs whose maps are missing are
left out. `--noise` and `--resolution` draw the picture otherwise.

    python benchmarks/localization_occupancy.py [--data FOLDER] [--log NAME ...] [--method enml]
        [--resolution 0.05] [--noise 0.015] [--scans N] [--quick]
"""

# ruff: noqa: T201
import argparse
import tempfile
from dataclasses import replace
from pathlib import Path

from localization_logs import DATA, HEADINGS, QUICK_SCANS, line, localized
from synthetic.occupancy_picture import write_occupancy

from mend.localization.logs.reading import read_log
from mend.localization.methods import METHODS, warm_up
from mend.maps.occupancy.lines import lines_of
from mend.maps.occupancy.nav2_file import read_occupancy_grid
from mend.maps.vector_map_file import read_vector_map


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--data", type=Path, default=DATA / "localization")
    parser.add_argument("--log", action="append", help="only this one; may be repeated")
    parser.add_argument("--method", choices=METHODS, default="enml")
    parser.add_argument("--resolution", type=float, default=0.05, help="metres")
    parser.add_argument("--noise", type=float, default=0.015, help="metres")
    parser.add_argument("--scans", type=int, help="only the first so many of each log")
    parser.add_argument("--quick", action="store_true", help=f"{QUICK_SCANS} scans of each log")
    given = parser.parse_args()
    scans = QUICK_SCANS if given.quick else given.scans
    warm_up(given.method)
    print(HEADINGS)
    for path in sorted((given.data / "logs").glob("*.log.gz")):
        name = path.name.removesuffix(".log.gz").removesuffix("-corrected")
        map_path = given.data / "log_maps" / f"{name}.vectormap.txt"
        if (given.log and name not in given.log) or not map_path.exists():
            continue
        log = read_log(path)
        log = replace(log, steps=log.steps[:scans])
        drawn = read_vector_map(map_path)
        with tempfile.TemporaryDirectory() as folder:
            picture = write_occupancy(
                drawn, Path(folder), resolution_m=given.resolution, noise_m=given.noise
            )
            extracted = lines_of(read_occupancy_grid(picture))
        for what, vector_map in (("vector", drawn), ("picture", extracted)):
            summary = localized(given.method, vector_map, log, 1)
            print(
                f"{line(f'{name} {what}', given.method, summary)} {len(vector_map)} segments",
                flush=True,
            )


if __name__ == "__main__":
    main()
