"""An example package as if it were installed: its entry points are found."""

import tomllib
from pathlib import Path

EXAMPLES = Path(__file__).parents[2] / "examples"


def install(example: str, folder: Path) -> None:
    """Make the folder, once it is on the path, provide what the example's package does."""
    text = (EXAMPLES / example / "pyproject.toml").read_text()
    project = tomllib.loads(text)["project"]
    metadata = folder / f"{project['name'].replace('-', '_')}-{project['version']}.dist-info"
    metadata.mkdir()
    named = f"Name: {project['name']}\nVersion: {project['version']}\n"
    (metadata / "METADATA").write_text(f"Metadata-Version: 2.1\n{named}")
    lines = []
    for group, points in project["entry-points"].items():
        lines += [f"[{group}]", *(f"{name} = {target}" for name, target in points.items())]
    (metadata / "entry_points.txt").write_text("\n".join(lines))
