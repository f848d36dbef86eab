"""`mend scene`: make up scenes."""

from typing import Annotated

import typer
import yaml

from mend.server.cli.failures import told_plainly

app = typer.Typer(name="scene", help="Make up scenes.", no_args_is_help=True, rich_markup_mode=None)


@app.callback()
def scene() -> None:
    """Make up scenes."""


@app.command("random", short_help="Print a random scene, or a task tree for it.")
def random(
    seed: Annotated[int, typer.Option(min=0, help="Another scene for each; always the same.")],
    parts: Annotated[
        int | None, typer.Option(min=1, max=30, help="How many parts; without it, 1 to 30.")
    ] = None,
    world: Annotated[
        str, typer.Option(help="The world whose robot has to be able to do it.")
    ] = "workcell",
    tree: Annotated[
        bool, typer.Option("--tree", help="Print the task tree that places all of its parts.")
    ] = False,
) -> None:
    """Print a random scene file, or with --tree the task file for it.

    Its parts have any size, colour and pose that the world's robot can do. Keep the scene as
    scenes/random_SEED.yaml beside the task file, or give it to `mend run` with --scene.
    """
    from mend.server.scene_checks import load_world_checks
    from mend.sim.random_scene import random_scene, scene_document

    with told_plainly():
        check = load_world_checks().only(world).check_of(world)
        made = random_scene(seed, parts, check)
    document = made.tree if tree else scene_document(made.scene)
    typer.echo(
        yaml.safe_dump(document, sort_keys=False, default_flow_style=None, width=100), nl=False
    )
