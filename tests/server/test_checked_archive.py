"""What may be a robot's model is kept, and whatever could hurt who draws it is refused."""

import contextlib
import io
import tracemalloc
import zipfile

import pytest
from hypothesis import given
from hypothesis import strategies as st
from languages_of_console import refused_in_every_language
from small_model import BARE, DAE, DESCRIPTION, OBJ, PNG, STL, packed

from mend.errors import WrongInputError
from mend.server.models.checked_archive import check_archive, check_description, unpacked_bytes

ROOM = 10**6


def urdf(inside: str) -> bytes:
    return f"<robot name='r'><link name='a'/>{inside}</robot>".encode()


def shape(inside: str) -> bytes:
    return urdf(f"<link name='b'><visual>{inside}</visual></link>" + JOINT)


JOINT = "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"


def test_an_archive_keeps_what_the_description_needs_and_nothing_else() -> None:
    checked = check_archive(packed({"notes.txt": b"ours", "meshes/spare.stl": STL}), ROOM)
    with zipfile.ZipFile(io.BytesIO(checked.archive)) as archive:
        assert archive.namelist() == [
            "lamp/meshes/foot.stl", "meshes/base.obj", "meshes/shade.dae", "robot.urdf",
        ]  # fmt: skip
        assert archive.read("robot.urdf").decode() == DESCRIPTION


def test_other_files_are_another_version() -> None:
    version = check_archive(packed(), ROOM).version
    assert check_archive(packed({"notes.txt": b"ours"}), ROOM).version == version
    assert check_archive(packed({"meshes/base.obj": OBJ + b"v 1 1 1\n"}), ROOM).version != version


def test_pictures_of_meshes_belong_to_them() -> None:
    image = b"<library_images><image><init_from>../red.png</init_from></image></library_images>"
    shade = DAE.replace(b"<library_geometries>", image + b"<library_geometries>")
    checked = check_archive(packed({"meshes/shade.dae": shade, "red.png": PNG}), ROOM)
    with zipfile.ZipFile(io.BytesIO(checked.archive)) as archive:
        assert "red.png" in archive.namelist()
    with refused_in_every_language(WrongInputError, r"needs red\.png, which is not"):
        check_archive(packed({"meshes/shade.dae": shade}), ROOM)


def test_a_description_that_needs_no_files_may_come_alone() -> None:
    assert check_description(BARE.encode()).version
    with refused_in_every_language(WrongInputError, "send both in one archive"):
        check_description(DESCRIPTION.encode())


EXPANDING = b'<!DOCTYPE r [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><robot name="&b;"/>'
DEEP = b"<robot name='r'>" + b"<a>" * 300 + b"</a>" * 300 + b"</robot>"
LOOP = (
    "<link name='b'/><link name='c'/>"
    "<joint name='j' type='fixed'><parent link='b'/><child link='c'/></joint>"
    "<joint name='k' type='fixed'><parent link='c'/><child link='b'/></joint>"
)
MIMIC = (
    "<link name='b'/><joint name='j' type='fixed'><parent link='a'/><child link='b'/>"
    "<mimic joint='{}'/></joint>"
)


@pytest.mark.parametrize(
    ("description", "why"),
    [
        (b"no XML", "line 1: it is not XML"),
        (b"<robot name='r'>", "it is not XML"),
        (EXPANDING, "document type"),
        (b"<robot name='r'><link name='&other;'/></robot>", "it is not XML"),
        (DEEP, "levels deep"),
        (b"<sdf/>", "outermost element is <robot>, not <sdf>"),
        (b"<robot xmlns:xacro='x'><xacro:arm/></robot>", "expand it first"),
        (b"<robot name='r'/>", "one link has no parent, and not 0"),
        (urdf("<link name='b'/>"), "one link has no parent, and not 2"),
        (urdf("<link name='a'/>"), "the link 'a' is there more than once"),
        (urdf("<link/>"), "has no name"),
        (urdf("<link name='b'/>" + JOINT + JOINT), "the joint 'j' is there more than once"),
        (urdf(JOINT), "the joint 'j' has no link as its child"),
        (urdf(JOINT.replace("fixed", "elastic")), "of no type of"),
        (urdf(LOOP), "in a loop"),
        (urdf(MIMIC.format("k")), "mimics 'k', which is not there"),
        (urdf(MIMIC.format("j")), "mimics one that mimics it"),
        (shape("<geometry/>"), "without one shape"),
        (shape("<geometry><torus/></geometry>"), "not torus"),
        (shape("<geometry><box size='1 2'/></geometry>"), "3 numbers with blanks between"),
        (shape("<geometry><box size='1 2 nan'/></geometry>"), "3 numbers"),
        (shape("<geometry><mesh/></geometry>"), "a <mesh> has no 'filename'"),
        (urdf("<material name='m'><color/></material>"), "a <color> has no 'rgba'"),
    ],
)
def test_a_description_that_cannot_be_drawn_is_refused(description: bytes, why: str) -> None:
    with refused_in_every_language(WrongInputError, why):
        check_archive(packed({"robot.urdf": description}), ROOM)


@pytest.mark.parametrize(
    "said",
    [
        "http://elsewhere/arm.stl", "file:///etc/passwd.stl", "//elsewhere/arm.stl",
        "/etc/arm.stl", "../arm.stl", "meshes/../../arm.stl", "package://../arm.stl",
        "package://a/../../arm.stl", "meshes\\arm.stl", "meshes/%2e%2e/arm.stl", "arm.stl?x",
        "arm.stl#x", "arm.exe", "robot.urdf", "data:model/stl,x.stl", "a" * 300 + ".stl",
    ],
)  # fmt: skip
def test_a_description_names_nothing_outside_its_archive(said: str) -> None:
    mesh = shape(f"<geometry><mesh filename='{said}'/></geometry>")
    with refused_in_every_language(WrongInputError, r"robot\.urdf names"):
        check_archive(packed({"robot.urdf": mesh}), ROOM)


@pytest.mark.parametrize("name", ["../evil.stl", "/evil.stl", "a/../../evil", "a\\b", "a\nb"])
def test_no_file_of_an_archive_leads_out_of_it(name: str) -> None:
    with refused_in_every_language(WrongInputError, "names are relative"):
        check_archive(packed({name: b""}), ROOM)


@pytest.mark.parametrize(
    ("name", "content", "why"),
    [
        ("lamp/meshes/foot.stl", b"GIF89a", "it is no STL file"),
        ("lamp/meshes/foot.stl", STL[:-1], "it is no STL file"),
        ("meshes/base.obj", b"\0v 1 2 3", "it is no OBJ file"),
        ("meshes/base.obj", b"", "it is no OBJ file"),
        ("meshes/shade.dae", b"<svg/>", "begins with <svg>"),
        ("meshes/shade.dae", EXPANDING, "document type"),
        ("meshes/shade.dae", DAE[:200], "it is not XML"),
        ("meshes/shade.dae", None, "which is not in the archive"),
    ],
)
def test_meshes_are_what_their_names_say(name: str, content: bytes | None, why: str) -> None:
    with refused_in_every_language(WrongInputError, why):
        check_archive(packed({name: content}), ROOM)


def test_text_as_stl_is_one_too() -> None:
    text = b"solid foot\nfacet normal 0 0 1\nendfacet\nendsolid foot\n"
    assert check_archive(packed({"lamp/meshes/foot.stl": text}), ROOM).version


def test_no_more_is_unpacked_than_there_is_room_for() -> None:
    bomb = packed({"meshes/base.obj": OBJ + b"#" * 10**7})
    assert len(bomb) < 10**5
    with refused_in_every_language(WrongInputError, "may have 1000000 bytes in all") as refused:
        check_archive(bomb, ROOM)
    assert refused.value.limit == "model_bytes"


def with_size(archive: bytes, size: int) -> bytes:
    """The archive with another size told of the file that its list has last."""
    at = archive.rindex(b"PK\x01\x02") + 24
    return archive[:at] + size.to_bytes(4, "little") + archive[at + 4 :]


def test_no_more_is_unpacked_than_a_file_is_said_to_have() -> None:
    bomb = io.BytesIO()
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("robot.urdf", BARE + " " * 10**8)
    tracemalloc.start()
    with refused_in_every_language(WrongInputError, "cannot be read"):
        check_archive(with_size(bomb.getvalue(), 1000), ROOM)
    assert tracemalloc.get_traced_memory()[1] < 10**7
    tracemalloc.stop()


@pytest.mark.parametrize("packing", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_packings_that_unpack_without_bounds_are_refused(packing: int) -> None:
    sent = io.BytesIO()
    with zipfile.ZipFile(sent, "w", packing) as archive:
        archive.writestr("robot.urdf", BARE)
    with refused_in_every_language(WrongInputError, "deflate it, or store it"):
        check_archive(sent.getvalue(), ROOM)


def test_a_file_without_a_name_is_refused() -> None:
    good = packed({"x": b""})
    entry, end = good.rindex(b"PK\x01\x02"), good.rindex(b"PK\x05\x06")
    torn = bytearray(good[: entry + 46] + good[entry + 47 :])
    torn[entry + 28] = 0
    size = int.from_bytes(good[end + 12 : end + 16], "little") - 1
    torn[end + 11 : end + 15] = size.to_bytes(4, "little")
    with refused_in_every_language(WrongInputError, "cannot be read"):
        check_archive(bytes(torn), ROOM)


def test_many_files_are_refused() -> None:
    with refused_in_every_language(WrongInputError, "more than 500 files"):
        check_archive(packed({f"{number}.txt": b"" for number in range(501)}), ROOM)
    with refused_in_every_language(WrongInputError, "more than 1000 files and folders"):
        check_archive(packed({f"{number}/": b"" for number in range(1001)}), ROOM)


def test_an_archive_says_how_much_is_in_it() -> None:
    assert unpacked_bytes(packed({"spare.stl": bytes(10**6)})) > 10**6
    assert unpacked_bytes(b"no archive") == 0


def test_a_mesh_may_name_a_picture_often_and_at_no_length() -> None:
    named = b"<image><init_from>../red.png</init_from></image>" * 1000
    shade = b"<COLLADA>" + named + b"</COLLADA>"
    assert check_archive(packed({"meshes/shade.dae": shade, "red.png": PNG}), ROOM).version
    long = b"<COLLADA><image><init_from>" + b"a" * 900_000 + b".png</init_from></image></COLLADA>"
    with refused_in_every_language(WrongInputError, r"shade\.dae names 'aaa"):
        check_archive(packed({"meshes/shade.dae": long}), ROOM)


@given(st.binary(max_size=200), st.integers(0, 2000), st.binary(min_size=1, max_size=8))
def test_bytes_that_are_no_archive_are_refused_with_a_sentence(
    noise: bytes, at: int, damage: bytes
) -> None:
    good = packed()
    at %= len(good)
    for sent in (noise, good[:at], good[:at] + damage + good[at + len(damage) :]):
        with contextlib.suppress(WrongInputError):
            check_archive(sent, ROOM)


def scene(nodes: str) -> bytes:
    return f"<COLLADA><library_nodes>{nodes}</library_nodes></COLLADA>".encode()


def doubling(times: int) -> bytes:
    """Nodes each of which holds the one before it twice."""
    pair = "<node id='n{}'><instance_node url='#n{}'/><instance_node url='#n{}'/></node>"
    return scene("<node id='n0'/>" + "".join(pair.format(i, i - 1, i - 1) for i in range(1, times)))


@pytest.mark.parametrize(
    ("shade", "why"),
    [
        (doubling(40), "more than 100000 nodes"),
        (scene("<node/>" * 100_001), "more than 100000 nodes"),
        (scene("<node id='a'><instance_node url='#a'/></node>"), "holds itself"),
        (scene("<node id='a'><node id='a'/></node>"), "holds itself"),
        (b"<COLLADA><accessor stride='999999999'/></COLLADA>", "'stride' of an <accessor>"),
        (b"<COLLADA><vcount>3 999999999</vcount></COLLADA>", "more corners than there are"),
        (b"<COLLADA><vcount>three</vcount></COLLADA>", "more corners than there are"),
    ],
)
def test_a_mesh_that_becomes_far_more_than_it_is_is_refused(shade: bytes, why: str) -> None:
    with refused_in_every_language(WrongInputError, why):
        check_archive(packed({"meshes/shade.dae": shade}), ROOM)


def test_a_file_counts_as_often_as_it_is_drawn() -> None:
    shapes = "<visual><geometry><mesh filename='big.obj'/></geometry></visual>" * 3
    sent = packed(
        {
            "robot.urdf": urdf(f"<link name='b'>{shapes}</link>{JOINT}"),
            "big.obj": OBJ + b"#" * 400_000,
        }
    )
    with refused_in_every_language(WrongInputError, "as often as it is drawn") as refused:
        check_archive(sent, ROOM)
    assert refused.value.limit == "model_bytes"
    assert check_archive(sent, 2 * ROOM).version


def test_many_shapes_are_refused() -> None:
    shapes = "<visual><geometry><box size='1 1 1'/></geometry></visual>" * 5001
    with refused_in_every_language(WrongInputError, "more than 5000 shapes"):
        check_description(urdf(f"<link name='b'>{shapes}</link>{JOINT}"))


def test_nodes_may_hold_others_and_shapes_have_many_corners() -> None:
    counts = b"<library_geometries><vcount>4 3\n4 </vcount><p>" + b"1 " * 11 + b"</p>"
    shade = doubling(10).replace(
        b"<library_nodes>", counts + b"</library_geometries><library_nodes>"
    )
    assert check_archive(packed({"meshes/shade.dae": shade}), ROOM).version
