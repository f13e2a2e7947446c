# SPDX-License-Identifier: Apache-2.0
"""Wrong input of every command: the documented exit code, exactly one clear line on stderr, nothing on stdout, nothing left behind."""

import os

import pytest

CUBE = """ply
format ascii 1.0
element vertex 8
property float x
property float y
property float z
element face 12
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
3 0 2 1
3 0 3 2
3 4 5 6
3 4 6 7
3 0 1 5
3 0 5 4
3 1 2 6
3 1 6 5
3 2 3 7
3 2 7 6
3 3 0 4
3 3 4 7
"""
NO_FACES = CUBE.replace("element face 12", "element face 0").split("3 0 2 1\n")[0]

FILES = {
    "newer.vmap": b"VANTMAP3" + 8 * b"\0",
    "short.vmap": b"VANTMAP2\0\0\0",
    "empty.ply": b"",
    "empty.pcd": b"",
    "empty.xyz": b"",
    "cube.ply": CUBE.encode(),
    "cut.ply": CUBE[:-30].encode(),
    "nan.ply": CUBE.replace("1 1 1\n0 1 1", "nan 1 1\n0 1 1").encode(),
    "no_faces.ply": NO_FACES.encode(),
    "index.ply": CUBE.replace("3 3 4 7", "3 3 4 8").encode(),
    "noise.ply": b"ply\n\x00\xff\x13garbage",
    "cut.pcd": b"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nPOINTS 9\nDATA ascii\n1 2 3\n",
    "huge.pcd": b"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nPOINTS 4000000000\nDATA binary\nxyz",
    "nan.xyz": b"nan nan nan\nnan nan nan\n",
    "words.xyz": b"1 2 3\n4 five 6\n",
    "flat.xyz": b"1 2\n3 4\n",
    "huge.ply": b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\nabc",
    "key.toml": b'[scene]\nname = "planar"\n[surface]\netta = 0.1\n',
    "stage.toml": b'[scene]\nname = "planar"\n[surfaces]\neta = 0.1\n',
    "value.toml": b'[scene]\nname = "planar"\n\n[surface]\neta = -0.1\n',
    "syntax.toml": b'[scene\nname = "planar"\n',
    "nameless.toml": b"[surface]\neta = 0.1\n",
    "bare.toml": b'name = "planar"\n',
    "broken.log": b"VANTSCAN\x01\x00\x00\x00\x07\x00\x00\x00",
    "short.log": b"VANT",
    "empty.vti": b"",
    "not.vti": b"<VTKFile><nothing/></VTKFile>",
    "solid.stl": b"solid nothing\nendsolid nothing\n",
    "words.txt": b"hello world\n",
}

EXPLORE = ["explore", "planar", "-o", "out"]

# Arguments, exit code, and what the line must say.
TABLE = [
    ([], 2, None),
    (["explor"], 2, "did you mean explore?"),
    (["--bogus"], 2, "unknown command"),
    # explore: usage
    (["explore"], 2, "SCENE is missing"),
    (["explore", "planar", "extra", "-o", "out"], 2, "extra: not expected"),
    (EXPLORE + ["--etta", "1"], 2, "--etta: unknown option: did you mean --eta?"),
    (EXPLORE + ["--eta"], 2, "--eta"),
    (EXPLORE + ["--eta", "0"], 2, "surface.eta = 0: must be"),
    (EXPLORE + ["--eta", "-1"], 2, "surface.eta = -1: must be"),
    (EXPLORE + ["--eta", "abc"], 2, "surface.eta = abc: must be"),
    (EXPLORE + ["--eta", "nan"], 2, "surface.eta = nan: must be"),
    (EXPLORE + ["--eta", "inf"], 2, "surface.eta = inf: must be"),
    (EXPLORE + ["--voxel", "0"], 2, "explore.voxel = 0: must be"),
    (EXPLORE + ["--grid", "1.5"], 2, "explore.grid = 1.5: must be"),
    (EXPLORE + ["--range", "-5"], 2, "sensor.range = -5: must be"),
    (EXPLORE + ["--step-deg", "0"], 2, "sensor.step_deg"),
    (EXPLORE + ["--clearance", "-1"], 2, "planner.clearance = -1: must be"),
    (EXPLORE + ["--noise", "-1"], 2, "sensor.range_noise = -1: must be"),
    (EXPLORE + ["--seed", "x"], 2, "explore.seed = x: must be"),
    (EXPLORE + ["--max-scans", "0"], 2, "--max-scans: 0: must be"),
    (EXPLORE + ["--max-scans", "9999999999999999999"], 2, "--max-scans"),
    (EXPLORE + ["--threads", "-1"], 2, "--threads: -1: must be"),
    (EXPLORE + ["--set", "surface.etta=1"], 2, "surface.etta: no such option: did you mean surface.eta?"),
    (EXPLORE + ["--set", "nonsense"], 2, "must be stage.option=value"),
    (EXPLORE + ["--set", "planner.metric=best"], 2, "must be ray | boundary"),
    (EXPLORE + ["--set", "surface.paper=yes"], 2, "must be true | false"),
    (EXPLORE + ["--remove", "1"], 2, "only with --resume"),
    (EXPLORE + ["--resume", "--force"], 2, "one of them"),
    (EXPLORE + ["--config", "none.toml"], 3, "none.toml: "),
    # explore: scene
    (["explore", "planr", "-o", "out"], 2, "planr"),
    (["explore", "planar:blobs=-3", "-o", "out"], 2, "blobs"),
    (["explore", "planar:nonsense=3", "-o", "out"], 2, "nonsense"),
    (["explore", "none.ply", "-o", "out"], 3, "none.ply"),
    (["explore", "none.toml", "-o", "out"], 3, "none.toml"),
    (["explore", "empty.ply", "-o", "out"], 2, "empty.ply"),
    (["explore", "cut.ply", "-o", "out"], 2, "cut.ply"),
    (["explore", "nan.ply", "-o", "out"], 2, "nan.ply"),
    (["explore", "index.ply", "-o", "out"], 2, "index.ply"),
    (["explore", "no_faces.ply", "-o", "out"], 2, "no_faces.ply"),
    (["explore", "solid.stl", "-o", "out"], 2, "solid.stl"),
    (["explore", "noise.ply", "-o", "out"], 2, "noise.ply"),
    (["explore", "cube.ply+planar", "-o", "out"], 2, "planar: not a scene file"),
    (["explore", "key.toml", "-o", "out"], 2, "key.toml:4: surface.etta: no such option: did you mean surface.eta?"),
    (["explore", "stage.toml", "-o", "out"], 2, "stage.toml:4: surfaces.eta: no such option"),
    (["explore", "value.toml", "-o", "out"], 2, "value.toml:5: surface.eta = -0.1: must be"),
    (["explore", "syntax.toml", "-o", "out"], 2, "syntax.toml:1"),
    (["explore", "nameless.toml", "-o", "out"], 2, "no scene is named"),
    (["explore", "bare.toml", "-o", "out"], 2, "bare.toml:1: name: must stand in a table"),
    (EXPLORE + ["--start", "1,2,3"], 2, "scene.start: 3 numbers"),
    (EXPLORE + ["--start", "1"], 2, "scene.start = 1: must be"),
    (EXPLORE + ["--start", "a,b"], 2, "scene.start = a"),
    (EXPLORE + ["--start", "nan,1"], 2, "scene.start = nan: must be"),
    (EXPLORE + ["--start", "500,500"], 2, None),
    (["explore", "pipes:symmetric=1", "--start", "{inside}", "-o", "out"], 2, None),
    (["explore", "pipes", "--voxel", "0.0005", "-o", "out"], 4, "needs"),
    (["explore", "planar", "--voxel", "0.0001", "-o", "out"], 4, "needs"),
    # explore: folder
    (["explore", "planar", "-o", "cube.ply"], 2, "cube.ply: is a file"),
    (["explore", "planar", "-o", "occupied"], 2, "occupied: the folder is not empty, and not a run"),
    (["explore", "planar", "--force", "-o", "occupied"], 2, "occupied: the folder is not empty, and not a run"),
    (["explore", "planar", "--resume", "-o", "out"], 2, "out: no run to resume"),
    (["explore", "planar", "-o", "/proc/none/out"], 3, "/proc/none"),
    (["explore", "planar", "-o", "cube.ply/out"], None, "cube.ply"),
    # scan
    (["scan"], 2, "SCENE is missing"),
    (["scan", "planar", "--at", "2,2"], 2, "-o"),
    (["scan", "planar", "--at", "2,2", "-o", "out.e57"], 2, "out.e57: must end in"),
    (["scan", "planar", "--at", "2", "-o", "out.ply"], 2, "--at"),
    (["scan", "planar", "--at", "2,2,2", "-o", "out.ply"], 2, "--at: 3 numbers"),
    (["scan", "planar", "--at", "x,2", "-o", "out.ply"], 2, "--at"),
    (["scan", "planar", "--at", "nan,2", "-o", "out.ply"], 2, "--at"),
    (["scan", "cube.ply", "--at", "0.5,0.5,0.5", "-o", "out.ply"], 2, None),
    (["scan", "planar", "--at", "2,2", "-o", "no/such/folder/out.ply"], 3, "no/such/folder"),
    (["scan", "none.ply", "--at", "2,2,2", "-o", "out.ply"], 3, "none.ply"),
    # paper
    (["paper"], 2, "NAME is missing: must be one of fig2, fig3"),
    (["paper", "fig1", "-o", "out"], 2, "fig1: not a table or figure we make: must be one of fig2, fig3, fig4, fig5, fig6, fig7, table1"),
    (["paper", "table9"], 2, "table9: not a table or figure we make: must be one of fig2, fig3, fig4, fig5, fig6, fig7, table1"),
    (["paper", "table1", "--step-deg", "0"], 2, "sensor.step_deg = 0: must be"),
    # audit
    (["audit"], 2, "SCENE is missing"),
    (["audit", "planr"], 2, "planr"),
    (["audit", "planar:blobs=-3"], 2, "blobs"),
    (["audit", "none.ply"], 3, "none.ply"),
    (["audit", "planar", "--variants", "defaut"], 2, "defaut: must be of all, none, default"),
    (["audit", "planar", "--variants", "none"], 2, "no variant is named"),
    (["audit", "planar", "--variants", "default,default"], 2, "default: named twice"),
    (["audit", "planar", "--variant", "calm"], 2, "--variant: calm: must be NAME=stage.option=value"),
    (["audit", "planar", "--variant", "calm=planner.lamda_factor=1"], 2, "did you mean planner.lambda_factor?"),
    (["audit", "planar", "--variant", "calm=explore.voxel=1"], 2, "explore.voxel: must be the same for all variants"),
    (["audit", "planar", "--variant", "a/b=planner.rays=9"], 2, "a/b: a name must be"),
    (["audit", "planar", "--starts", "0"], 2, "--starts: 0: must be"),
    (["audit", "planar", "--layouts", "x"], 2, "--layouts: x: must be"),
    (["audit", "planar", "--cap", "0.5"], 2, "--cap: 0.5: must be"),
    (["audit", "planar", "--bound", "-1"], 2, "--bound: -1: must be"),
    (["audit", "planar", "--set", "planner.rays=0"], 2, "planner.rays = 0: must be"),
    (["audit", "planar", "--voxel", "0.0001"], 2, "nodes of the reference lattice: must be below"),
    (["audit", "planar", "--truth", "planar"], 2, "--truth: only of a run folder"),
    (["audit", "planar", "-o", "occupied"], 2, "occupied: the folder is not empty, and not of an audit"),
    (["audit", "planar", "-o", "cube.ply"], 2, "cube.ply: is a file"),
    (["audit", "planar", "-o", "/proc/none/out", "--starts", "1", "--targets", "9", "--candidates", "9", "--walls", "9"], 3, "/proc/none"),
    # reconstruct
    (["reconstruct", "-o", "out.ply"], 2, "CLOUD is missing"),
    (["reconstruct", "none.ply", "-o", "out.ply"], 3, "none.ply"),
    (["reconstruct", "empty.ply", "-o", "out.ply"], 2, "empty.ply: the file is empty"),
    (["reconstruct", "empty.pcd", "-o", "out.ply"], 2, "empty.pcd"),
    (["reconstruct", "empty.xyz", "-o", "out.ply"], 2, "empty.xyz"),
    (["reconstruct", "noise.ply", "-o", "out.ply"], 2, "noise.ply"),
    (["reconstruct", "huge.ply", "-o", "out.ply"], 2, "exceed the file"),
    (["reconstruct", "cut.pcd", "-o", "out.ply"], 2, "cut.pcd:7: 9 points exceed the file"),
    (["reconstruct", "huge.pcd", "-o", "out.ply"], 2, "exceed the file"),
    (["reconstruct", "words.xyz", "-o", "out.ply"], 2, "words.xyz:2: five: not a number"),
    (["reconstruct", "nan.xyz", "-o", "out.ply"], 2, "no finite point"),
    (["reconstruct", "cube.ply", "flat.xyz", "-o", "out.ply"], 2, "flat.xyz: a cloud of 2 dimensions"),
    (["reconstruct", "broken.log", "-o", "out.ply"], 2, "broken.log:12: dimension 7"),
    (["reconstruct", "short.log", "-o", "out.ply"], 2, "short.log:0: not a scan log"),
    (["reconstruct", "cube.ply", "--eta", "0", "-o", "out.ply"], 2, "surface.eta = 0"),
    (["reconstruct", "cube.ply", "--set", "surface.x=0", "-o", "out.ply"], 2, "surface.x: no such option"),
    (["reconstruct", "cube.ply", "-o", "out.doc"], 2, "out.doc: must end in"),
    (["reconstruct", "cube.ply", "-o", "no/such/folder/out.ply"], 3, "no/such/folder"),
    # publish, merge
    (["publish", "-o", "out.vmap"], 2, "CLOUD is missing"),
    (["publish", "cube.ply"], 2, "MAP is missing"),
    (["publish", "cube.ply", "-o", "out.ply"], 2, "out.ply: must end in .vmap"),
    (["publish", "none.ply", "-o", "out.vmap"], 3, "none.ply"),
    (["publish", "cube.ply", "flat.xyz", "-o", "out.vmap"], 2, "flat.xyz: a cloud of 2 dimensions"),
    (["publish", "cube.ply", "--eta", "0", "-o", "out.vmap"], 2, "surface.eta = 0"),
    (["publish", "cube.ply", "--source", "a\nb", "-o", "out.vmap"], 2, "printable"),
    (["publish", "cube.ply", "--onto", "cube.ply", "-o", "out.vmap"], 2, "cube.ply:0: not a map of vantage"),
    (["publish", "cube.ply", "-o", "no/such/folder/out.vmap"], 3, "no/such/folder"),
    (["merge", "-o", "out.vmap"], 2, "MAP is missing"),
    (["merge", "newer.vmap"], 2, "FILE is missing"),
    (["merge", "newer.vmap", "-o", "out.vmap"], 2, "newer.vmap:7: a map of another version"),
    (["merge", "short.vmap", "-o", "out.vmap"], 2, "short.vmap:11: the file ends"),
    (["merge", "none.vmap", "-o", "out.vmap"], 3, "none.vmap"),
    (["merge", "cube.ply", "-o", "out.vmap"], 2, "cube.ply:0"),
    (["info", "newer.vmap"], 2, "newer.vmap:7"),
    # visibility
    (["visibility"], 2, "PATCHES is missing"),
    (["visibility", "cube.ply", "-o", "out.vti"], 2, "--from is missing"),
    (["visibility", "cube.ply", "--from", "2,2", "-o", "out.vti"], 2, "--from: 2 numbers"),
    (["visibility", "cube.ply", "--from", "2,2,2", "-o", "out.png"], 2, "out.png: must end in .vti"),
    (["visibility", "cube.ply", "--from", "2,2,2", "--voxel", "0", "-o", "out.vti"], 2, "--voxel"),
    (["visibility", "cube.ply", "--from", "2,2,2", "--voxel", "0.0001", "-o", "out.vti"], 4, "needs"),
    (["visibility", "none.ply", "--from", "2,2,2", "-o", "out.vti"], 3, "none.ply"),
    (["visibility", "nan.ply", "--from", "2,2,2", "-o", "out.vti"], 2, "finite"),
    (["visibility", "index.ply", "--from", "2,2,2", "-o", "out.vti"], 2, "vertex 8 of 8"),
    (["visibility", "cut.ply", "--from", "2,2,2", "-o", "out.vti"], 2, "cut.ply"),
    # scene
    (["scene"], 2, "NAME is missing"),
    (["scene", "planar"], 2, "-o FILE is missing"),
    (["scene", "planr", "-o", "out.ply"], 2, "planr"),
    (["scene", "pipes", "-o", "out.doc"], 2, "out.doc"),
    (["scene", "pipes", "-o", "no/such/folder/out.ply"], 3, "no/such/folder"),
    # info
    (["info"], 2, "FILE is missing"),
    (["info", "none"], 3, "none: no such file"),
    (["info", "occupied"], 2, "is no run"),
    (["info", "empty.vti"], 2, "empty.vti: the file is empty"),
    (["info", "not.vti"], 2, "not.vti"),
    (["info", "words.txt"], 2, "words.txt:1"),
    (["info", "broken.log"], 2, "broken.log:12"),
    (["info", "syntax.toml"], 2, "syntax.toml:1"),
    # config
    (["config"], 2, "ACTION is missing"),
    (["config", "print"], 2, "must be dump"),
    (["config", "dump", "--set", "x=1"], 2, "x: no such option"),
]


def snapshot(folder):
    return {path.relative_to(folder): path.read_bytes() if path.is_file() else None for path in folder.rglob("*")}


@pytest.fixture()
def place(tmp_path):
    for name, content in FILES.items():
        (tmp_path / name).write_bytes(content)
    (tmp_path / "occupied").mkdir()
    (tmp_path / "occupied/letter.txt").write_text("dear")
    return tmp_path


@pytest.fixture(scope="session")
def inside(vantage, tmp_path_factory):
    """A place inside a cylinder of the scene pipes:symmetric=1: the middle of the first one, from its mesh."""
    path = tmp_path_factory.mktemp("pipes") / "pipes.obj"
    assert vantage("scene", "pipes:symmetric=1,cylinders=1", "-o", path).returncode == 0
    points = [tuple(map(float, line.split()[1:4])) for line in path.read_text().splitlines() if line.startswith("v ")]
    return ",".join(str(sum(values) / len(points)) for values in zip(*points))


@pytest.mark.parametrize("arguments, code, says", TABLE, ids=lambda value: " ".join(value) if isinstance(value, list) else None)
def test_one_line_and_nothing_left(vantage, place, arguments, code, says, request):
    if "{inside}" in arguments:
        arguments = [a.replace("{inside}", request.getfixturevalue("inside")).replace("symmetric=1", "symmetric=1,cylinders=1") for a in arguments]
    before = snapshot(place)
    result = vantage(*arguments, cwd=place, timeout=60)
    assert result.returncode == code if code is not None else result.returncode in (2, 3), result.stderr
    if not arguments:
        return  # The bare program shows its help.
    assert result.stdout == ""
    lines = result.stderr.splitlines()
    assert len(lines) == 1 and lines[0].startswith("vantage: "), result.stderr
    if says is not None:
        assert says in lines[0]
    assert snapshot(place) == before


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_may_not_be_written(vantage, tmp_path):
    (tmp_path / "locked").mkdir(mode=0o555)
    result = vantage("explore", "planar", "-o", tmp_path / "locked/out")
    assert result.returncode == 3 and len(result.stderr.splitlines()) == 1
    assert list((tmp_path / "locked").iterdir()) == []


def test_a_run_folder_is_not_overwritten(vantage, tmp_path):
    run = tmp_path / "run"
    assert vantage("explore", "planar", "--max-scans", 2, "-q", "-o", run).returncode == 0
    before = snapshot(run)
    for arguments in (["planar"], ["planar", "--force", "--start", "-900,0"], ["discs", "--resume"], ["planar", "--resume", "--eta", "0.3"], ["planar", "--resume", "--max-scans", "1"],
                      ["planar", "--resume", "--remove", "5"]):
        result = vantage("explore", *arguments, "-o", run)
        assert result.returncode == 2, arguments
        assert len(result.stderr.splitlines()) == 1, result.stderr
        assert snapshot(run) == before, arguments
    assert [path.name for path in tmp_path.iterdir()] == ["run"]


def test_a_scene_that_changed_is_not_resumed(vantage, tmp_path):
    (tmp_path / "cube.ply").write_text(CUBE)
    arguments = ["explore", tmp_path / "cube.ply", "--start", "0.5,0.5,2", "--grid", "20", "--step-deg", "5", "-o", tmp_path / "run"]
    first = vantage(*arguments, "--max-scans", 1, "-q")
    assert first.returncode == 0, first.stderr
    (tmp_path / "cube.ply").write_text(CUBE.replace("1 1 1\n0 1 1", "1 1 2\n0 1 1"))
    result = vantage("explore", "--resume", "-o", tmp_path / "run")
    assert result.returncode == 2 and "is not what it was" in result.stderr
