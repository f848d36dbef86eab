"""`mend train-colors`: what colour each object has, learned from pictures and kept in a file."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mend.server.cli.failures import CommandLineError, told_plainly

if TYPE_CHECKING:
    from mend.sim.world import ColorTeacher


def train_colors(
    output: Annotated[
        Path, typer.Argument(metavar="OUTPUT", help="The colour model's file, as .npz.")
    ],
    images: Annotated[
        Path | None,
        typer.Option(
            help="A folder with one folder per object of .png pictures, each with an alpha channel "
            "or with a mask beside it (<picture>.mask.png)."
        ),
    ] = None,
    scene: Annotated[
        Path | None, typer.Option(help="A scene file: learn from rendered pictures of its objects.")
    ] = None,
    world: Annotated[str, typer.Option(help="The world that renders them.")] = "tabletop",
) -> None:
    """Train the colour model of a robot's cameras, from your pictures or from rendered ones."""
    from mend.robots.vision.color_model import ColorModel
    from mend.robots.vision.training import load_samples
    from mend.server.cli.task_files import read_scene

    if (images is None) == (scene is None):
        raise CommandLineError("train-colors needs either --images or --scene")
    if output.suffix != ".npz":
        raise CommandLineError(
            f"the colour model's file has to end in .npz, which '{output}' does not"
        )
    with told_plainly():
        if images is not None:
            model = ColorModel.train(load_samples(images))
        else:
            assert scene is not None, "one of the two is given"
            model = _teacher(world).train_colors(read_scene(scene))
        output.parent.mkdir(parents=True, exist_ok=True)
        model.save(output)
    typer.echo(f"{output}: the colours of {', '.join(model.names)}")


def _teacher(world: str) -> "ColorTeacher":
    from mend.sim.world import ColorTeacher
    from mend.tasks.plugins import load_plugins

    adapters = load_plugins("mend.worlds")
    if world not in adapters:
        raise CommandLineError(f"there is no world '{world}'; there are {', '.join(adapters)}")
    adapter: object = adapters[world]
    if not isinstance(adapter, ColorTeacher):
        raise CommandLineError(f"the world '{world}' renders no pictures to learn colours from")
    return adapter
