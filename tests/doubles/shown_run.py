"""A run's state and a robot's hello, for tests of what people are shown."""

from uuid import UUID

from sample_events import RUN, WALL_TIME
from task_documents import definition_of

from mend.dialogue.registry import load_scripts
from mend.robots.link.messages import Hello, PoseLayout, Poses, ReachLimits, ShownObject, ShownPose
from mend.server.journal.events import RunStarted
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.run_state import RunState
from mend.tasks.scene import Base, Place, Pose, Scene, SceneObject

SCENE = Scene(
    name="bench",
    objects={
        "cup": SceneObject(color=(1.0, 0.0, 0.0), size=(0.05, 0.06, 0.07), pose=Pose(x=1, y=0))
    },
    places={"tray": Place(pose=Pose(x=0.5, y=0.1, yaw=1.0))},
)
SHOWS = PoseLayout(
    model="pr2", joints=["elbow"], objects=[ShownObject(name="cup", size=(0.05, 0.06, 0.07))]
)
AT = (0.5, 0.1, 0.7, 0.0, 0.0, 0.0, 1.0)


def driving_state(*robots: tuple[str, Base]) -> RunState:
    """A run with these robots, each where it begins."""
    return run_state(scene=SCENE.model_copy(update={"robots": dict(robots)}))


def run_state(run: UUID = RUN, scene: Scene = SCENE) -> RunState:
    tree = definition_of({"behavior": "pick_and_place", "object": "cup", "place": "tray"})
    started = RunStarted(
        time=0.0,
        wall_time=WALL_TIME,
        run=run,
        tree_name="tree",
        tree=tree.to_json(),
        scene=scene.model_dump(mode="json"),
        world="tabletop",
        robots=list(scene.robots) or ["arm"],
        seed=0,
        speed=1.0,
        scenario=None,
        options=RunRequest(tree="tree").model_dump(mode="json"),
    )
    return RunState(started, load_scripts())


def hello(shows: PoseLayout | None = SHOWS, *, robot: str = "arm", boot: str = "b1") -> Hello:
    return Hello(
        protocol=1,
        robot=robot,
        boot=boot,
        behaviors=["pick_and_place"],
        cameras=["head"],
        reach=ReachLimits(x=0.0, y=0.0, min_m=0.2, max_m=0.8),
        time=0.0,
        simulated=True,
        shows=shows,
    )


def poses(angle_rad: float = 0.0, *, joints: int = 1, held: bool = False) -> Poses:
    return Poses(
        time=0.0,
        joints=[angle_rad] * joints,
        tool=AT,
        opening_m=0.05,
        objects=[ShownPose(pose=AT, held=held)],
    )
