# SPDX-License-Identifier: Apache-2.0
"""Malformed files from upstream test suites (data set corrupt): each has its outcome in a table, a clear error in one line or a correct load."""

import json

import pytest

# What the file is, if it is refused: words of the one line. What it holds, if it is odd but valid: facts that `vantage info --json` states.
TABLE = {
    # assimp: a fuzzer's find, huge counts, wrong indices, nothing at all; and odd but valid ones.
    "assimp/OutOfMemory.off": "353535235358 vertices",
    "assimp/badArray.gltf": "meshes[0].primitives: must be an array",
    "assimp/badUint.gltf": "BoxTextured0.bin",
    "assimp/crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply": ".ply:7: property type",
    "assimp/empty.obj": "the file is empty",
    "assimp/empty.ply": "the file is empty",
    "assimp/malformed.obj": "line 28: face corner '0'",
    "assimp/box_longline.obj": {"kind": "scene", "vertices": 8, "facets": 944, "bounds": [[-0.5] * 3, [0.5] * 3]},
    "assimp/box_nested_animation_4286.dae": {"kind": "scene", "vertices": 8, "facets": 12},
    "assimp/cube_binary_starts_with_nl.ply": {"kind": "scene", "vertices": 8, "facets": 12},
    "assimp/number_formats.obj": {"kind": "scene", "vertices": 3, "facets": 1, "bounds": [[-1, -2, -3], [1, 2, 3]]},
    "assimp/triangle_with_empty_solid.stl": {"kind": "scene", "vertices": 3, "facets": 1},
    # E57: a wrong checksum; a section header that no record needs; a file without scans.
    "e57/bad-crc.e57": "bad-crc.e57:0: the page's checksum does not match",
    "e57/InvalidCVHeader.e57": {"kind": "point cloud", "format": "E57", "points": 0, "position": [0, 0, 0]},
    "e57/empty.e57": {"kind": "point cloud", "format": "E57", "points": 0, "scans": []},
    # PDAL: a count of variable records that is wrong hurts no point; 719 announced records of which the last is cut do.
    "pdal/bad_vlr_count.las": {"kind": "point cloud", "format": "LAS 1.2, point format 3", "points": 10},
    "pdal/garbage_nVariableLength.las": ":227: 719 points of 20 bytes exceed the file",
    "pdal/gps-time-nan.las": {"kind": "point cloud", "format": "LAS 1.2, point format 1", "points": 1, "not_finite": 0},
    "pdal/no-points.las": {"kind": "point cloud", "format": "LAS 1.2, point format 3", "points": 0, "bounds": None},
    "pdal/badheader.txt": "badheader.txt:1: columns 1 and 3 are both called X",
    "pdal/missingheader.pcd": "missingheader.pcd:1: 289814.15: not a header line of PCD",
    "pdal/no_vertex.obj": "holds no triangles",
    "pdal/no_vertex.ply": "no vertex element",
    "pdal/issue_2421.ply": {"kind": "point cloud", "points": 1, "bounds": [[1.23457, 12345.6789, 1234567890.12345]] * 2},
    "pdal/mesh.ply": {"kind": "scene", "vertices": 4, "facets": 2, "bounds": [[1, 1, 0], [2, 2, 2]]},
    # trimesh: a mesh with holes is a mesh; an element of no faces makes no mesh.
    "trimesh/busted.STL": {"kind": "scene", "facets": 3878},
    "trimesh/points_emptyface.ply": {"kind": "point cloud", "format": "PLY, ascii", "points": 1024, "not_finite": 0},
}


def test_every_file_has_its_outcome(data):
    folder = data("corrupt")
    files = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file() and path.name not in ("LICENSE", "README.md", "readme.txt")}
    assert files == set(TABLE)


@pytest.mark.parametrize("name", TABLE)
def test_the_outcome(vantage, data, tmp_path, name):
    path, expected = data("corrupt") / name, TABLE[name]
    result = vantage("info", path, "--json", cwd=tmp_path, timeout=20)
    assert list(tmp_path.iterdir()) == []
    if isinstance(expected, str):
        assert result.returncode == 2 and result.stdout == "", result.stderr
        lines = result.stderr.splitlines()
        assert len(lines) == 1 and lines[0].startswith(f"vantage: {path}") and expected in lines[0], result.stderr
        return
    assert result.returncode == 0 and result.stderr == "", result.stderr
    facts = json.loads(result.stdout)
    assert {key: facts.get(key) for key in expected} == expected


def test_scans_of_a_file_are_told_apart(vantage, tmp_path):
    scan = "1\n2\n{0} 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n{0} 0 0 1\n1 2 3 0.5\n0 0 0 0.5\n"
    (tmp_path / "two.txt").write_text(scan.format(5) + scan.format(9))
    facts = json.loads(vantage("info", tmp_path / "two.txt", "--json").stdout)
    assert facts["format"] == "PTX" and facts["points"] == 2 and facts["bounds"] == [[6, 2, 3], [10, 2, 3]]
    assert [scan["position"] for scan in facts["scans"]] == [[5, 0, 0], [9, 0, 0]]
    assert facts["scans"][0]["rays"] == {"columns": 1, "rows": 2, "no_return": 1, "no_data": 0}


def test_a_compressed_las_says_who_decompresses_it(vantage, data):
    result = vantage("info", data("las_sample/autzen_trim.laz"))
    assert result.returncode == 2 and "`vantage-convert IN.laz OUT.las`" in result.stderr and len(result.stderr.splitlines()) == 1
