"""MRPT's programs as a peer: what they are given, and what is made of what they say."""

from dataclasses import replace
from pathlib import Path

import mrpt_peer
import numpy as np
import pytest

from maps.vector_map import VectorMap
from robots.localization.logs.log import Log
from robots.localization.synthetic.settings import SceneSettings
from robots.localization.synthetic.world import scene

ROOM = VectorMap.of([[0, 0, 8, 0], [8, 0, 8, 6], [8, 6, 0, 6], [0, 6, 0, 0]])


@pytest.fixture(scope="module")
def log() -> Log:
    return scene(ROOM, SceneSettings(length_m=1.0), 1).log


@pytest.fixture
def programs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Programs that keep what they are given; the filter then prints what the test wrote."""
    for name in mrpt_peer.PROGRAMS:
        program = tmp_path / name
        program.write_text(
            f'#!/bin/sh\nhere="{tmp_path}"\ncp drive.log map.png "$here" 2>/dev/null\n'
            f'[ {name} = pf-localization ] && cp drive.ini "$here" && cat "$here/said"\n'
            f'[ ! -e "$here/fails" ]\n'
        )
        program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    return tmp_path


def test_its_poses_are_read_one_per_scan(programs: Path, log: Log) -> None:
    said = [f"PDF estimation: ({x:.1f}, 2.0, 90.0)" for x in range(len(log))]
    (programs / "said").write_text("\n".join(said))
    poses = mrpt_peer.mrpt_poses(ROOM, log)
    np.testing.assert_allclose(poses[:, 0], np.arange(len(log)))
    np.testing.assert_allclose(poses[:, 2], np.pi / 2)


def test_it_starts_where_the_log_does_and_stays_there_until_it_says_more(
    programs: Path, log: Log
) -> None:
    (programs / "said").write_text("PDF estimation: (1.0, 2.0, 0.0)")
    poses = mrpt_peer.mrpt_poses(ROOM, log)
    assert log.start is not None
    np.testing.assert_allclose(poses[:-1], np.tile(log.start, (len(log) - 1, 1)))
    x = float(log.start[0])
    assert f"init_PDF_min_x={x - 0.2:.4f}" in (programs / "drive.ini").read_text()


def test_it_never_sees_the_references(programs: Path, log: Log) -> None:
    (programs / "said").write_text("PDF estimation: (1.0, 2.0, 0.0)")
    mrpt_peer.mrpt_poses(ROOM, log)
    given = (programs / "drive.log").read_text()
    elsewhere = replace(
        log,
        steps=tuple(
            replace(step, reference=None if step.reference is None else step.reference + 5.0)
            for step in log.steps
        ),
    )
    mrpt_peer.mrpt_poses(ROOM, elsewhere)
    assert (programs / "drive.log").read_text() == given
    assert given.count("FLASER 271 ") == len(log)


def test_a_program_that_says_nothing_or_fails_is_told(programs: Path, log: Log) -> None:
    (programs / "said").write_text("nothing of use")
    with pytest.raises(RuntimeError, match="printed no estimate"):
        mrpt_peer.mrpt_poses(ROOM, log)
    (programs / "fails").touch()
    with pytest.raises(RuntimeError, match="image2gridmap ended with 1"):
        mrpt_peer.mrpt_poses(ROOM, log)


def test_without_its_programs_it_is_not_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    assert not mrpt_peer.installed()
