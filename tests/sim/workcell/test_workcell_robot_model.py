"""The robot's files are made once, repaired, and mean the same to kinematics and physics."""

import threading
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mend.errors import WrongInputError
from mend.robots.arm.motion.kinematics import KinematicChain
from mend.sim.workcell import robot_model
from mend.sim.workcell.mesh_repair import read_stl, repair_stl
from mend.sim.workcell.physics import Client, connect, to_matrix
from mend.sim.workcell.quiet import silenced
from mend.sim.workcell.robot_model import (
    ARM_JOINTS,
    FOREARM_CAMERA_FRAME,
    TOOL_FRAME,
    check_installed,
    robot_urdf,
)
from mend.sim.world import WorldUnavailableError


@pytest.fixture(scope="module")
def engine() -> tuple[Client, int, dict[str, int]]:
    """The robot with none of its links merged, and its links by name."""
    client = connect()
    with silenced():
        robot = client.loadURDF(str(robot_urdf()), useFixedBase=True)
    infos = [client.getJointInfo(robot, index) for index in range(client.getNumJoints(robot))]
    links = {info[12].decode(): info[0] for info in infos}
    joints = {info[1].decode(): info[0] for info in infos}
    return client, robot, {**links, **joints}


@pytest.mark.parametrize(
    ("frame", "joints"), [(TOOL_FRAME, ARM_JOINTS), (FOREARM_CAMERA_FRAME, ARM_JOINTS[:5])]
)
@settings(max_examples=20, deadline=None)
@given(shares=st.lists(st.floats(0.0, 1.0), min_size=7, max_size=7))
def test_kinematics_agree_with_the_physics_engine(
    engine: tuple[Client, int, dict[str, int]],
    frame: str,
    joints: tuple[str, ...],
    shares: list[float],
) -> None:
    client, robot, index = engine
    chain = KinematicChain(robot_urdf(), frame, joints)
    angles = chain.lower + np.array(shares[: len(joints)]) * (chain.upper - chain.lower)
    for name, angle in zip(joints, angles, strict=True):
        client.resetJointState(robot, index[name], angle)
    state = client.getLinkState(robot, index[frame], computeForwardKinematics=True)
    assert np.allclose(chain.pose(angles), to_matrix(state[4], state[5]), atol=2e-5)


def test_a_chain_that_is_not_there_is_named() -> None:
    with pytest.raises(WrongInputError, match="no link 'tail'"):
        KinematicChain(robot_urdf(), "tail", ARM_JOINTS)
    with pytest.raises(WrongInputError, match="expected r_wrist_roll_joint"):
        KinematicChain(robot_urdf(), FOREARM_CAMERA_FRAME, ("r_wrist_roll_joint",))


def test_processes_that_race_make_the_files_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    start = threading.Barrier(4)
    made: list[Path] = []

    def make() -> None:
        start.wait()
        made.append(robot_urdf())

    threads = [threading.Thread(target=make) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(made) == 4
    assert len(set(made)) == 1
    assert made[0].read_text().count("<link") > 50
    assert [each.name for each in (tmp_path / "mend").iterdir()] == [made[0].parent.name]


def test_every_mesh_of_the_robot_has_unit_normals() -> None:
    meshes = list(robot_urdf().parent.glob("meshes/**/*.stl"))
    assert len(meshes) >= 15
    for mesh in meshes:
        lengths = np.linalg.norm(read_stl(mesh.read_bytes())["normal"], axis=1)
        assert np.allclose(lengths, 1.0, atol=1e-5), mesh.name


def test_repair_turns_normals_outward_and_drops_empty_triangles() -> None:
    triangle = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype="<f4")
    flat = np.zeros((3, 3), dtype="<f4")
    body = b"".join(
        np.full(3, 9, dtype="<f4").tobytes() + corners.tobytes() + b"\0\0"
        for corners in (triangle, flat)
    )
    repaired = read_stl(repair_stl(bytes(80) + (2).to_bytes(4, "little") + body))
    assert len(repaired) == 1
    assert np.allclose(repaired["normal"][0], (0, 0, 1))
    assert np.allclose(repaired["corners"][0], triangle)


def test_a_truncated_mesh_is_refused() -> None:
    with pytest.raises(ValueError, match="buffer"):
        repair_stl(bytes(80) + (3).to_bytes(4, "little") + bytes(50))


def test_a_missing_engine_is_told_with_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robot_model.importlib.util, "find_spec", lambda _: None)
    with pytest.raises(WorldUnavailableError, match=r"Python 3\.10 and 3\.11 only"):
        check_installed()


@pytest.mark.parametrize("missing", ["ruckig", "pinocchio", "coal"])
def test_a_missing_library_is_told_with_what_to_install(
    monkeypatch: pytest.MonkeyPatch, missing: str
) -> None:
    monkeypatch.setattr(
        robot_model.importlib.util, "find_spec", lambda name: name != missing or None
    )
    told = rf"(?i)needs {missing}: .*mend-robots\[workcell\]"
    with pytest.raises(WorldUnavailableError, match=told):
        check_installed()


def test_a_missing_description_is_told_with_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def missing(_: str) -> metadata.Distribution:
        raise metadata.PackageNotFoundError

    monkeypatch.setattr(robot_model.metadata, "distribution", missing)
    with pytest.raises(WorldUnavailableError, match=r"mend-robots\[workcell\]"):
        robot_urdf()
