# SPDX-License-Identifier: Apache-2.0
"""vantage convert: what others read in the files it writes, what it says of what they cannot hold, and what it refuses."""

import json
import re
import shutil
import struct
import zlib

import laspy
import numpy
import pytest

# Centimetres in UTM: floats cannot hold them.
UTM = "".join(f"{512345.01 + 0.37 * i:.2f} {5412345.99 - 0.11 * i:.2f} {100 + 0.05 * i:.2f}\n" for i in range(400))
# Two scans of a scanner that was moved; the second ray of each met nothing.
PTX = "".join(
    f"1\n3\n{x} 20 1.5\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n{x} 20 1.5 1\n1 2 3 0.5\n0 0 0 0.5\n4 5 6.25 0.5\n" for x in (10, 110)
)


@pytest.fixture(scope="module")
def run(vantage, tmp_path_factory):
    """A run of the plane."""
    folder = tmp_path_factory.mktemp("convert") / "run"
    assert vantage("explore", "planar", "--max-scans", "3", "-q", "-o", folder).returncode == 0
    return folder


@pytest.fixture(scope="module")
def surface(vantage, tmp_path_factory):
    """Patches of a scan in space."""
    folder = tmp_path_factory.mktemp("surface")
    assert vantage("scan", "pipes", "--step-deg", "1", "-o", folder / "scan.ply").returncode == 0
    assert vantage("reconstruct", folder / "scan.ply", "--eta", "0.2", "-o", folder / "surface.ply").returncode == 0
    return folder / "surface.ply"


def convert(vantage, *arguments):
    done = vantage("convert", *arguments)
    assert done.returncode == 0, done.stderr
    return done


def write(path, text):
    path.write_text(text)
    return path


def points_of(text):
    return numpy.array([[float(word) for word in line.split()] for line in text.splitlines()])


@pytest.mark.parametrize("version", ["1.2", "1.4"])
@pytest.mark.parametrize("crs", [[], ["--crs", "EPSG:25832"]])
def test_las_is_what_laspy_reads(vantage, tmp_path, version, crs):
    source, out = write(tmp_path / "utm.xyz", UTM), tmp_path / "utm.las"
    convert(vantage, source, out, "--las", version, "--resolution", "0.01", *crs)
    las = laspy.read(out)
    assert str(las.header.version) == version
    assert las.header.point_format.id == (6 if version == "1.4" and not crs else 0)
    assert numpy.abs(las.xyz - points_of(UTM)).max() < 2e-9
    assert list(las.header.scales) == [0.01] * 3
    assert numpy.allclose(las.header.mins, las.xyz.min(axis=0), atol=1e-9) and numpy.allclose(las.header.maxs, las.xyz.max(axis=0), atol=1e-9)
    assert las.header.global_encoding.wkt == (las.header.point_format.id == 6)
    assert set(las.return_number) == set(las.number_of_returns) == {1}
    assert las.header.number_of_points_by_return[0] == 400
    keys = [key for vlr in las.header.vlrs for key in vlr.geo_keys]
    assert [(key.id, key.value_offset) for key in keys] == ([(1024, 1), (3072, 25832)] if crs else [])


def test_las_keeps_scans_apart_and_its_coordinate_system(vantage, tmp_path):
    first, second = tmp_path / "a.las", tmp_path / "b.las"
    done = convert(vantage, write(tmp_path / "two.ptx", PTX), first, "--crs", "EPSG:2056")
    assert "does not hold: 2 poses; 2 rays without return; what a point has beside its place" in done.stderr
    assert list(laspy.read(first).point_source_id) == [1, 1, 2, 2]
    assert json.loads(convert(vantage, first, second, "--json").stdout)["epsg"] == 2056
    assert first.read_bytes()[:227] == second.read_bytes()[:227]
    assert "EPSG:2056" in convert(vantage, first, tmp_path / "c.ply").stderr


def test_empty_las(vantage, tmp_path):
    source = write(tmp_path / "none.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n")
    for version in ("1.2", "1.4"):
        out = tmp_path / f"none{version}.las"
        convert(vantage, source, out, "--las", version)
        assert len(laspy.read(out).points) == 0


@pytest.mark.parametrize("ending", ["ply", "pcd", "xyz", "csv", "las"])
@pytest.mark.parametrize("text", [[], ["--ascii"]])
def test_round_trips_keep_every_digit(vantage, tmp_path, ending, text):
    if text and ending not in ("ply", "pcd"):
        pytest.skip("binary or text, not both")
    source, between, back = write(tmp_path / "utm.xyz", UTM), tmp_path / f"b.{ending}", tmp_path / "c.xyz"
    assert convert(vantage, source, between, *text).stderr == ""
    convert(vantage, between, back)
    if ending == "las":
        assert numpy.abs(points_of(back.read_text()) - points_of(UTM)).max() < 2e-9
    else:
        assert numpy.array_equal(points_of(back.read_text()), points_of(UTM))


def test_floats_say_what_they_lose(vantage, tmp_path):
    done = convert(vantage, write(tmp_path / "utm.xyz", UTM), tmp_path / "utm.pcd", "--number", "float")
    assert float(re.search(r"digits beyond a float \(up to ([0-9.]+)\)", done.stderr)[1]) == pytest.approx(0.24, abs=0.02)
    assert b"SIZE 4 4 4" in (tmp_path / "utm.pcd").read_bytes()


def test_one_scan_of_several_keeps_its_pose(vantage, tmp_path):
    source = write(tmp_path / "two.ptx", PTX)
    convert(vantage, source, tmp_path / "second.pcd", "--scan", "1")
    assert b"VIEWPOINT 110 20 1.5 1 0 0 0\n" in (tmp_path / "second.pcd").read_bytes()
    assert "2 poses; " in convert(vantage, source, tmp_path / "both.pcd").stderr
    done = vantage("convert", source, tmp_path / "third.pcd", "--scan", "2")
    assert done.returncode == 2 and "--scan: 2: must be a whole number, 0 .. 1" in done.stderr


def arrays_of_vti(path):
    """Extent, and the arrays of a VTK image, decoded as VTK's file format says."""
    data = path.read_bytes()
    head, raw = data.split(b'<AppendedData encoding="raw">\n   _')
    extent = [int(word) for word in re.search(rb'WholeExtent="([^"]*)"', head)[1].split()]
    arrays = {}
    for kind, name, offset in re.findall(rb'DataArray type="(\w+)" Name="(\w+)" format="appended" offset="(\d+)"', head):
        at = int(offset)
        blocks, size, last = struct.unpack_from("<3Q", raw, at)
        sizes = struct.unpack_from(f"<{blocks}Q", raw, at + 24)
        at += 24 + 8 * blocks
        values = b""
        for k, packed in enumerate(sizes):
            block = zlib.decompress(raw[at : at + packed])
            assert len(block) == (last if k + 1 == blocks and last else size)
            values += block
            at += packed
        arrays[name.decode()] = numpy.frombuffer(values, {b"UInt8": "u1", b"Float32": "<f4"}[kind])
    return extent, arrays


def test_a_field_is_the_same_in_vti_and_npy(vantage, tmp_path, run):
    extent, arrays = arrays_of_vti(run / "belief.vti")
    shape = tuple(extent[2 * a + 1] + 1 for a in range(3))
    assert set(arrays) == {"state", "psi", "E"}
    for name, values in arrays.items():
        done = convert(vantage, run, tmp_path / f"{name}.npy", "--array", name)
        assert "the place of node 0 0 0" in done.stderr and "array " in done.stderr
        loaded = numpy.load(tmp_path / f"{name}.npy")
        assert loaded.shape == shape and loaded.dtype == values.dtype
        # a[i, j, k] is node i + nx (j + ny k) of the image.
        assert numpy.array_equal(loaded, values.reshape(shape[::-1]).transpose(2, 1, 0), equal_nan=True)
    convert(vantage, run / "belief.vti", tmp_path / "again.vti")
    assert (tmp_path / "again.vti").read_bytes() == (run / "belief.vti").read_bytes()
    convert(vantage, run, tmp_path / "psi.vti", "--array", "psi")
    assert set(arrays_of_vti(tmp_path / "psi.vti")[1]) == {"psi"}
    done = vantage("convert", run, tmp_path / "which.npy")
    assert done.returncode == 2 and "--array: is missing: one of state, psi, E" in done.stderr
    done = vantage("convert", tmp_path / "psi.vti", tmp_path / "psi.bt")
    assert done.returncode == 2 and "psi.vti: no array state in it, only psi" in done.stderr
    done = vantage("convert", tmp_path / "psi.vti", tmp_path / "psi.bt", "--array", "psi")
    assert done.returncode == 2 and "array psi: must be states" in done.stderr


def test_a_field_as_vdb_where_openvdb_is(vantage, tmp_path, run):
    done = vantage("convert", run, tmp_path / "psi.vdb", "--array", "psi")
    if done.returncode:
        assert (done.returncode, done.stderr) == (2, f"vantage: {tmp_path / 'psi.vdb'}: this build has no OpenVDB (libopenvdb-dev)\n")
        assert not (tmp_path / "psi.vdb").exists()
        return
    assert (tmp_path / "psi.vdb").read_bytes()[:4] == b" BDV"
    wrong = vantage("convert", run, tmp_path / "which.vdb")
    assert wrong.returncode == 2 and "--array: is missing: one of" in wrong.stderr


def leaves_of_bt(path):
    """Resolution, and {state: volume} of an OctoMap file in cubes, decoded as its format says."""
    data = path.read_bytes()
    assert data.startswith(b"# Octomap OcTree binary file\n")
    head, tree = data.split(b"\ndata\n", 1)
    size, resolution = int(re.search(rb"\nsize (\d+)", head)[1]), float(re.search(rb"\nres (\S+)", head)[1])
    words = struct.unpack(f"<{len(tree) // 2}H", tree)
    volume, count, at = {1: 0, 2: 0}, 1, 0

    def walk(side):
        nonlocal count, at
        word, at = words[at], at + 1
        states = [word >> (2 * i) & 3 for i in range(8)]
        count += sum(state != 0 for state in states)
        for state in states:
            if state in volume:
                volume[state] += (side // 2) ** 3
        for state in states:
            if state == 3:
                walk(side // 2)

    walk(1 << 16)
    assert at == len(words) and count == size
    return resolution, volume


def test_octomap_holds_what_is_free_and_occupied(vantage, tmp_path, run):
    done = convert(vantage, run, tmp_path / "belief.bt")
    assert "array psi; array E" in done.stderr
    state = arrays_of_vti(run / "belief.vti")[1]["state"]
    spacing = float(re.search(rb'Spacing="(\S+) ', (run / "belief.vti").read_bytes())[1])
    resolution, volume = leaves_of_bt(tmp_path / "belief.bt")
    assert resolution == spacing / 2
    assert volume == {1: 8 * (state == 1).sum(), 2: 8 * (state == 2).sum()}


def obj_of(path):
    lines = [line.split() for line in path.read_text().splitlines()]
    corners = numpy.array([[float(word) for word in line[1:]] for line in lines if line[0] == "v"])
    return corners, {kind: [[int(word) for word in line[1:]] for line in lines if line[0] == kind] for kind in "flp"}


def test_surfaces_go_to_obj_and_glb(vantage, tmp_path, surface):
    figures = json.loads(vantage("info", surface, "--json").stdout)
    done = convert(vantage, surface, tmp_path / "surface.obj")
    assert "does not hold: the certified errors" in done.stderr
    corners, elements = obj_of(tmp_path / "surface.obj")
    assert [len(elements[kind]) for kind in "flp"] == [figures["polygons"], figures["segments"], figures["points"]]
    assert numpy.array_equal([corners.min(axis=0), corners.max(axis=0)], figures["bounds"])
    assert sorted(index for kind in elements.values() for element in kind for index in element) == list(range(1, len(corners) + 1))

    convert(vantage, surface, tmp_path / "surface.glb")
    data = (tmp_path / "surface.glb").read_bytes()
    assert data[:4] == b"glTF" and struct.unpack_from("<2I", data, 4) == (2, len(data))
    head = json.loads(data[20 : 20 + struct.unpack_from("<I", data, 12)[0]])
    triangles = [p for p in head["meshes"][0]["primitives"] if p["mode"] == 4][0]
    assert head["accessors"][triangles["attributes"]["POSITION"]]["count"] == 3 * sum(len(face) - 2 for face in elements["f"])
    convert(vantage, surface, tmp_path / "again.ply")
    # The same patches, polygons first; so once more is no change.
    assert json.loads(vantage("info", tmp_path / "again.ply", "--json").stdout) == figures
    assert len((tmp_path / "again.ply").read_bytes()) == surface.stat().st_size
    convert(vantage, tmp_path / "again.ply", tmp_path / "more.ply")
    assert (tmp_path / "again.ply").read_bytes() == (tmp_path / "more.ply").read_bytes()
    # reconstruct writes as many lines itself, in its own order.
    assert vantage("reconstruct", surface.parent / "scan.ply", "--eta", "0.2", "-o", tmp_path / "direct.obj").returncode == 0
    assert sorted(line[:2] for line in (tmp_path / "direct.obj").open()) == sorted(line[:2] for line in (tmp_path / "surface.obj").open())


def test_stations_and_path_as_geojson(vantage, tmp_path, run):
    convert(vantage, run, tmp_path / "run.geojson", "--crs", "EPSG:25832")
    map_ = json.loads((tmp_path / "run.geojson").read_text())
    assert map_["crs"]["properties"]["name"] == "urn:ogc:def:crs:EPSG::25832"
    stations = [f for f in map_["features"] if f["properties"]["kind"] == "station"]
    table = numpy.loadtxt(run / "stations.csv", delimiter=",", skiprows=1)
    assert [f["properties"]["id"] for f in stations] == list(table[:, 0])
    assert numpy.array_equal([f["geometry"]["coordinates"] for f in stations], table[:, 1:4])
    (path,) = [f["geometry"] for f in map_["features"] if f["properties"]["kind"] == "path"]
    assert path["type"] == "LineString"
    assert numpy.array_equal(path["coordinates"], numpy.loadtxt(run / "path.csv", delimiter=",", skiprows=1))


def test_runs_and_logs_give_their_points(vantage, tmp_path, run):
    done = convert(vantage, run, tmp_path / "all.csv")
    assert re.search(r"3 poses; \d+ rays without return|3 poses", done.stderr)
    table = numpy.loadtxt(tmp_path / "all.csv", delimiter=",", skiprows=1)
    assert (tmp_path / "all.csv").read_text().startswith("x,y,scan\n") and set(table[:, 2]) == {0, 1, 2}
    convert(vantage, run / "scans.log", tmp_path / "one.xyz", "--scan", "1")
    assert numpy.array_equal(numpy.loadtxt(tmp_path / "one.xyz"), table[table[:, 2] == 1][:, :2])


@pytest.mark.parametrize("ending", ["pcd", "las", "csv", "xyz"])
def test_scan_writes_by_the_same_writers(vantage, tmp_path, ending):
    place = ["--at", "0,0,1", "--step-deg", "5"]
    assert vantage("scan", "pipes", *place, "-o", tmp_path / f"a.{ending}").returncode == 0
    assert vantage("scan", "pipes", *place, "-o", tmp_path / "a.log").returncode == 0
    convert(vantage, tmp_path / "a.log", tmp_path / f"b.{ending}")
    assert (tmp_path / f"a.{ending}").read_bytes() == (tmp_path / f"b.{ending}").read_bytes()


# Arguments, exit code, what the one line must say.
REFUSED = [
    (["IN.xyz"], 2, "OUT is missing"),
    ([], 2, "IN is missing"),
    (["IN.xyz", "out.foo"], 2, "out.foo: .foo: must end in .ply"),
    (["IN.xyz", "out"], 2, "out: no ending: must end in"),
    (["IN.xyz", "out.laz"], 2, "vantage-convert IN.las OUT.laz"),
    (["IN.xyz", "out.npy"], 2, "IN.xyz: holds scans, written as .ply .pcd .las .xyz .txt .asc .csv .geojson, not as .npy"),
    (["IN.xyz", "out.geojson"], 2, "--crs EPSG:CODE is missing"),
    (["IN.xyz", "out.geojson", "--crs", "EPSG:25832"], 2, "no scan of it says where it was taken"),
    (["IN.xyz", "out.las", "--crs", "EPSG:4326"], 2, "--crs: EPSG:4326: must be a projected system"),
    (["IN.xyz", "out.las", "--crs", "UTM32"], 2, "--crs: UTM32: must be EPSG:1024"),
    (["IN.xyz", "out.las", "--resolution", "0"], 2, "--resolution: 0: must be 1e-9 .. 1000"),
    (["IN.xyz", "out.las", "--resolution", "fine"], 2, "--resolution: fine"),
    (["FAR.xyz", "out.las", "--resolution", "1e-6"], 2, "needs 0.0023 or more"),
    (["IN.xyz", "out.las", "--las", "1.3"], 2, "--las: 1.3: must be 1.2 or 1.4"),
    (["IN.xyz", "out.las", "--ascii"], 2, "--ascii: only for .ply .pcd, not for .las"),
    (["IN.xyz", "out.ply", "--number", "half"], 2, "--number: half: must be float or double"),
    (["IN.xyz", "out.ply", "--array", "psi"], 2, "--array: only for .vti .npy .bt .vdb, not for .ply"),
    (["IN.xyz", "old.ply"], 2, "old.ply: is there already; --force replaces it"),
    (["IN.xyz", "no/such/folder/out.ply"], 3, "cannot write"),
    (["missing.xyz", "out.ply"], 3, "missing.xyz: no such file"),
    (["empty.xyz", "out.ply"], 2, "empty.xyz: the file is empty"),
    (["bad.xyz", "out.ply"], 2, "bad.xyz:2: five: not a number"),
    (["mesh.stl", "out.ply"], 2, "mesh.stl: a mesh: vantage scene FILE -o OUT"),
    (["set.toml", "out.ply"], 2, "neither scans (docs/12-files.md) nor a surface"),
    (["not.vti", "out.npy"], 2, "not.vti: not a VTK image"),
    ([".", "out.ply"], 2, "no run"),
    (["mesh.ply", "out.las"], 2, "mesh.ply: holds a surface, written as .ply .obj .glb, not as .las"),
    (["mesh.ply", "out.ply", "--ascii"], 2, "--ascii: only for points, not for a surface"),
    (["IN.xyz", "out.ply", "--fource"], 2, "unknown option: did you mean --force?"),
]


@pytest.fixture
def folder(tmp_path):
    write(tmp_path / "IN.xyz", "1 2 3\n4 5 6\n")
    write(tmp_path / "FAR.xyz", "0 0 0\n1e7 0 0\n")
    write(tmp_path / "empty.xyz", "")
    write(tmp_path / "bad.xyz", "1 2 3\n4 five 6\n")
    write(tmp_path / "old.ply", "precious")
    write(tmp_path / "mesh.stl", "solid a\nendsolid a\n")
    write(tmp_path / "set.toml", '[scene]\nname = "planar"\n')
    write(tmp_path / "not.vti", "<VTKFile><nothing/></VTKFile>")
    head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    write(tmp_path / "mesh.ply", head + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    return tmp_path


@pytest.mark.parametrize("arguments, code, message", REFUSED, ids=lambda value: " ".join(value) if isinstance(value, list) else None)
def test_refused_in_one_line_without_output(vantage, folder, arguments, code, message):
    before = {path: path.read_bytes() for path in folder.iterdir()}
    done = vantage("convert", *arguments, cwd=folder)
    assert done.returncode == code and done.stdout == "" and message in done.stderr, done.stderr
    assert done.stderr.count("\n") == 1 and done.stderr.startswith("vantage: ")
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


def test_force_replaces(vantage, folder):
    convert(vantage, folder / "IN.xyz", folder / "old.ply", "--force")
    assert (folder / "old.ply").read_bytes().startswith(b"ply\n")


def test_help_names_every_ending(vantage):
    text = vantage("convert", "--help").stdout
    for ending in ("ply", "pcd", "las", "xyz", "csv", "geojson", "obj", "glb", "vti", "npy", "bt", "vdb"):
        assert f".{ending}" in text


def test_info_knows_what_convert_wrote(vantage, tmp_path, run):
    def told(path):
        done = vantage("info", path, "--json")
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    convert(vantage, write(tmp_path / "utm.xyz", UTM), tmp_path / "utm.las", "--crs", "EPSG:25832")
    assert told(tmp_path / "utm.las")["crs"] == "EPSG:25832"
    convert(vantage, run, tmp_path / "state.npy", "--array", "state")
    assert re.fullmatch(r"'\|u1', \(\d+, \d+, 1\)", told(tmp_path / "state.npy")["numpy"])
    convert(vantage, run, tmp_path / "run.geojson", "--crs", "EPSG:25832")
    assert told(tmp_path / "run.geojson") == {"kind": "map features", "crs": "urn:ogc:def:crs:EPSG::25832", "features": {"station": 3, "path": 1}}
    convert(vantage, run, tmp_path / "belief.bt")
    assert told(tmp_path / "belief.bt")["kind"] == "point cloud"
    for text in ("", "[]", "{", '{"features": 1}', '{"features": [1, {"properties": null}], "crs": [1]}'):
        done = vantage("info", write(tmp_path / "odd.geojson", text))
        assert (done.returncode == 0) == text.startswith('{"features": ['), done.stderr
        assert done.returncode == 0 or (done.returncode == 2 and done.stderr.count("\n") == 1)
    deep = '{"features": ' + 100000 * "[" + 100000 * "]" + "}"
    assert "odd.geojson:112: JSON nests deeper than 100" in vantage("info", write(tmp_path / "odd.geojson", deep)).stderr
    for text in ("", '{"verdict": [1], "surface": {}}', '{"verdict": {}}', '{"verdict": {}, "surface": ' + 100000 * "["):
        shutil.copytree(run, tmp_path / "odd", dirs_exist_ok=True)
        done = vantage("info", write(tmp_path / "odd" / "result.json", text).parent)
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and "result.json" in done.stderr, done.stderr
