"""`mend model`: how the robots of a service that is there are drawn."""

import io
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mend.server.cli.asked_service import AskedService
from mend.server.cli.failures import CommandLineError, told_plainly
from mend.server.cli.rows import print_rows
from mend.server.cli.shared_options import with_shared_options

if TYPE_CHECKING:
    from mend.server.client import MendClient
    from mend.server.models.views import ModelView
    from mend.server.runtime.views import RobotView

app = typer.Typer(
    name="model",
    help="List, give, fetch and delete the models as which robots are drawn (docs/live_robots.md).",
    short_help="List, give and delete models of robots.",
    no_args_is_help=True,
    rich_markup_mode=None,
)

DESCRIPTIONS = (".urdf", ".xml")

Name = Annotated[
    str, typer.Argument(metavar="NAME", help="As robots say it in their hello (`shows.model`).")
]


@app.command("list")
@with_shared_options
def list_models(*, service: AskedService) -> None:
    """List the models that there are, and which robots say that they look so."""

    async def listed(client: "MendClient") -> tuple[list["ModelView"], list["RobotView"]]:
        return await client.models(), await client.robots()

    models, robots = service.asked(listed)
    print_rows(
        [
            (
                each.name,
                "a world's" if each.built_in else "uploaded",
                "" if each.built_in else str(sum(file.bytes for file in each.files)),
                ", ".join(robot.robot for robot in robots if robot.model == each.name),
            )
            for each in models
        ],
        ("model", "whose", "bytes", "robots"),
    )


@app.command()
@with_shared_options
def put(
    name: Name,
    source: Annotated[
        Path,
        typer.Argument(
            metavar="FILE",
            help="A ZIP with robot.urdf and its meshes, a folder with these, or a URDF that needs "
            "no other files.",
        ),
    ],
    *,
    service: AskedService,
) -> None:
    """Give a model; it takes the place of an uploaded one of this name."""
    with told_plainly():
        alone = source.suffix.lower() in DESCRIPTIONS
        sent = _packed(source) if source.is_dir() else source.read_bytes()

    async def give(client: "MendClient") -> "ModelView":
        return await (client.put_urdf if alone else client.put_model)(name, sent)

    kept = service.asked(give)
    files = "1 file" if len(kept.files) == 1 else f"{len(kept.files)} files"
    typer.echo(f"the robot model '{kept.name}' is kept: {files}")


@app.command()
@with_shared_options
def get(
    name: Name,
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Where to write its ZIP.")],
    *,
    service: AskedService,
) -> None:
    """Fetch an uploaded model as a ZIP, which `put` takes."""
    archive = service.asked(lambda client: client.model(name))
    with told_plainly():
        file.write_bytes(archive)
    typer.echo(f"{file}: {len(archive)} bytes")


@app.command()
@with_shared_options
def delete(name: Name, *, service: AskedService) -> None:
    """Delete an uploaded model; its robots are drawn as a gripper then."""
    service.asked(lambda client: client.delete_model(name))
    typer.echo(f"the robot model '{name}' is deleted")


def _packed(folder: Path) -> bytes:
    """A folder as a ZIP. Raises `CommandLineError`, and `OSError`."""
    if not (folder / "robot.urdf").is_file():
        raise CommandLineError(f"'{folder}' is no robot model: it has no robot.urdf")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for each in sorted(folder.rglob("*")):
            if each.is_file():
                # Without its time, which may be one that a ZIP cannot have.
                archive.writestr(each.relative_to(folder).as_posix(), each.read_bytes())
    return packed.getvalue()
