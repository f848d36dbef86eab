"""Frames hold what the documented format says, and come back whole out of what is stored."""

import math
import struct

from hypothesis import given
from hypothesis import strategies as st

from mend.robots.link.messages import IDENTITY, Poses, ShownPose
from mend.server.poses.arms import SeenArm
from mend.server.poses.bases import SeenBase
from mend.server.poses.frame import decode, encode, framed, time_of, unframed

number = st.floats(-1e6, 1e6, width=32)
pose = st.tuples(*[number] * 7)
shown = st.builds(
    ShownPose, pose=pose, held=st.booleans(), gone=st.booleans(), hidden=st.booleans()
)

told_poses = st.builds(
    Poses,
    time=st.just(0.0),
    joints=st.lists(number, max_size=8),
    tool=pose,
    opening_m=number,
)


@given(
    count=st.integers(0, 2**32 - 1),
    time_s=st.floats(0, 1e9),
    joints=st.lists(number, max_size=12),
    base=pose,
    tool=pose,
    opening_m=number,
    objects=st.lists(shown, max_size=8),
    bases=st.lists(st.builds(SeenBase, pose, st.floats(0, math.inf, width=32)), max_size=3),
)
def test_a_frame_can_be_read_as_documented(
    count: int,
    time_s: float,
    joints: list[float],
    base: tuple[float, ...],
    tool: tuple[float, ...],
    opening_m: float,
    objects: list[ShownPose],
    bases: list[SeenBase],
) -> None:
    poses = Poses.model_validate(
        {
            "type": "poses",
            "time": 0.0,
            "joints": joints,
            "base": base,
            "tool": tool,
            "opening_m": opening_m,
            "objects": objects,
        }
    )
    frame = encode(count, time_s, poses, bases)
    assert len(frame) == 76 + 4 * len(joints) + 32 * (len(objects) + len(bases))
    assert struct.unpack_from("<dIHH", frame) == (time_s, count, len(joints), len(objects))
    assert time_of(frame) == time_s
    assert list(struct.unpack_from(f"<{len(joints)}f", frame, 16)) == joints
    after = 16 + 4 * len(joints)
    assert struct.unpack_from("<7f", frame, after) == base
    assert struct.unpack_from("<7f", frame, after + 28) == tool
    assert struct.unpack_from("<f", frame, after + 56) == (opening_m,)
    for index, each in enumerate(objects):
        *values, flags = struct.unpack_from("<7fI", frame, after + 60 + 32 * index)
        assert tuple(values) == each.pose
        assert flags == 1 * each.held + 2 * each.gone + 4 * each.hidden
    after += 60 + 32 * len(objects)
    for index, seen in enumerate(bases):
        assert struct.unpack_from("<8f", frame, after + 32 * index) == (*seen.pose, seen.age_s)
    assert decode(frame).arms == []


@given(
    bases=st.lists(st.builds(SeenBase, pose, st.floats(0, math.inf, width=32)), max_size=3),
    arms=st.lists(
        st.builds(SeenArm, st.integers(0, 63), pose, st.floats(0, 1e6, width=32), told_poses),
        min_size=1,
        max_size=3,
    ),
)
def test_other_arms_follow_the_bases_and_say_how_long_they_are(
    bases: list[SeenBase], arms: list[SeenArm]
) -> None:
    shown = Poses(time=0.0, tool=IDENTITY, opening_m=0.0)
    frame = encode(1, 2.0, shown, bases, arms)
    length, mark = struct.unpack("<I4s", frame[-8:])
    assert mark == b"ARMS"
    assert len(frame) == 76 + 32 * len(bases) + length + 8
    after = 76 + 32 * len(bases)
    for arm in arms:
        poses = arm.poses
        joints = len(poses.joints)
        assert struct.unpack_from("<HH", frame, after) == (arm.number, joints)
        assert struct.unpack_from("<16f", frame, after + 4) == (
            *arm.base, *poses.tool, poses.opening_m, arm.age_s,
        )  # fmt: skip
        assert list(struct.unpack_from(f"<{joints}f", frame, after + 68)) == poses.joints
        after += 68 + 4 * joints
    assert after == len(frame) - 8
    read = decode(frame)
    assert [(each.pose, each.age_s) for each in read.robots] == [
        (each.pose, each.age_s) for each in bases
    ]
    assert [(each.number, each.base, each.tool, list(each.joints)) for each in read.arms] == [
        (each.number, each.base, each.poses.tool, each.poses.joints) for each in arms
    ]


@given(st.lists(st.binary(min_size=16, max_size=64), max_size=6), st.integers(0, 40))
def test_stored_frames_come_back_but_for_a_torn_last_one(frames: list[bytes], cut: int) -> None:
    stored = framed(frames)
    assert list(unframed(stored)) == frames
    kept = list(unframed(stored[: max(0, len(stored) - cut)]))
    assert kept == frames[: len(kept)]
    if cut == 0 or not frames:
        assert kept == frames
    elif cut < len(frames[-1]) + 4:
        assert kept == frames[:-1]
