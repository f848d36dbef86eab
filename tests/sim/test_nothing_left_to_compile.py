"""A simulated robot has compiled everything before it is at work."""

import subprocess
import sys

import pytest

AT_WORK = """
import sys
from numba.core.dispatcher import Dispatcher
from mend.robots.link.messages import Look, Start
from mend.sim.robot_process import find_world
from mend.sim.world import WorldSetup
from mend.tasks.scene_file import built_in_scene

def compiled():
    return {
        (name, value.py_func.__qualname__, str(signature))
        for name, module in list(sys.modules.items())
        if name.startswith(("mend.robots.", "mend.sim.", "mend.maps."))
        for value in vars(module).values()
        if isinstance(value, Dispatcher)
        for signature in value.signatures
    }

scene = built_in_scene("eket")
setup = WorldSetup(robots=["r"], scene=scene, seed=1, speed=None)
group = find_world(sys.argv[1]).create_agents(setup)
agent = group.agents[0]
before = compiled()
kinds = []
agent.attach(lambda body, *_: kinds.append(body.type), lambda _: None)
agent.handle("look", Look())
while group.advance(1.0):
    pass
for name in ("green_leg", "blue_leg"):
    thing = scene.objects[name]
    at = scene.places[name].pose
    agent.handle(name, Start(
        execution=name, node="/0", behavior="pick_and_place",
        parameters={"object": name, "place": name}, size=thing.size,
        target={"x": at.x, "y": at.y, "z": at.z, "yaw": at.yaw},
    ))
    while group.advance(1.0):
        pass
assert before
assert kinds.count("looked") == 1 and kinds.count("finished") == 2, kinds
print(*sorted(compiled() - before))
"""


@pytest.mark.slow(4)
@pytest.mark.parametrize("world", ["tabletop", "workcell"])
def test_nothing_is_left_to_compile_for_a_robot_at_work(world: str) -> None:
    if world == "workcell":
        pytest.importorskip("pybullet")
    left = subprocess.run(
        [sys.executable, "-c", AT_WORK, world], capture_output=True, text=True, check=False
    )
    assert (left.returncode, left.stdout.strip()) == (0, ""), left.stderr
