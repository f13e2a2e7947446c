# SPDX-License-Identifier: Apache-2.0
"""Degenerate clouds at the command line: none, one point, nothing finite, a million metres away. Each certificate is verified."""

import json

import pytest

NO_VERTEX = "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
NO_POINT = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 0\nHEIGHT 1\nPOINTS 0\nDATA ascii\n"


@pytest.fixture
def reconstruct(vantage, tmp_path):
    """reconstruct(text, "--eta", 0.1, name="cloud.xyz") -> (CompletedProcess, figures)"""

    def run(text, *arguments, name="cloud.xyz"):
        (tmp_path / name).write_text(text)
        result = vantage("reconstruct", tmp_path / name, "--verify", "--json", "-o", tmp_path / "surface.ply", *arguments)
        assert (tmp_path / "surface.ply").exists() == (result.returncode == 0)
        return result, json.loads(result.stdout) if result.returncode == 0 else None

    return run


def lines(points):
    return "".join(" ".join(repr(x) for x in p) + "\n" for p in points)


@pytest.mark.parametrize("name, text, says", [
    ("cloud.xyz", "", "the file is empty"),
    ("cloud.ply", NO_VERTEX, "no finite point"),
    ("cloud.pcd", NO_POINT, "no finite point"),
    ("cloud.xyz", "nan nan nan\nnan 1 2\n", "no finite point"),
    ("cloud.xyz", "inf 0 0\n0 -inf 0\n", "no finite point"),
    ("cloud.xyz", "1e30 0 0\n-1e30 0 0\n", "too fine for a domain this large"),
])  # fmt: skip
def test_nothing_to_reconstruct_is_bad_input(reconstruct, name, text, says):
    result, _ = reconstruct(text, name=name)
    assert (result.returncode, result.stdout) == (2, "")
    assert says in result.stderr and len(result.stderr.splitlines()) == 1


@pytest.mark.parametrize("dim", [2, 3])
def test_one_point_stands_for_itself(reconstruct, dim):
    cloud = lines([[1.5, -2.0, 1e6][:dim]])
    result, surface = reconstruct(cloud)
    assert (result.returncode, result.stderr) == (0, "")
    assert (surface["points"], surface["dim"]) == (1, dim)
    assert (surface["loose_points"], surface["fits"], surface["segments"], surface["nodes"]) == (1, 0, 0, 1)
    assert surface["verify"]["holds"] and surface["verify"]["data_to_surface"]["max_m"] < 1e-9
    result, surface = reconstruct(cloud, "--paper")  # It is lost, and the certificate says so.
    assert (result.returncode, result.stderr) == (0, "")
    assert (surface["points"], surface["fits"], surface["loose_points"]) == (1, 0, 0)
    assert surface["hausdorff"]["data_to_surface_m"] is None and surface["verify"]["holds"]


def test_what_is_not_finite_is_counted_and_left_out(reconstruct, vantage):
    wall = [[0.01 * (i % 40), 0.01 * (i // 40), 3.0] for i in range(1600)]
    clean = reconstruct(lines(wall))[1]
    bad = [[float("nan")] * 3, [float("inf"), 0.0, 0.0], [0.0, float("-inf"), float("nan")]]
    result, surface = reconstruct(lines(bad + wall + bad))
    assert (result.returncode, result.stderr) == (0, "")
    assert surface["not_finite"] == surface["verify"]["not_finite"] == 6
    assert surface["verify"]["holds"]
    for key in ("points", "nodes", "fits", "segments", "loose_points", "hausdorff"):
        assert surface[key] == clean[key]
    assert (clean["fits"], clean["nodes"]) == (1, 1)


@pytest.mark.parametrize("dim", [2, 3])
def test_millimetres_a_million_metres_away(reconstruct, dim):
    stairs = [[1e6 + 0.002 * i, 2e6 + 0.004 * (i // 25), 5e5][:dim] for i in range(200)]
    result, surface = reconstruct(lines(stairs), "--eta", 0.0015)
    assert (result.returncode, result.stderr) == (0, "")
    assert surface["verify"]["holds"] and surface["hausdorff"]["certified_m"] <= 0.0015
    assert surface["verify"]["data_to_surface"]["max_m"] <= 0.0015
    assert 8 <= surface["fits"] + surface["segments"] + surface["loose_points"] <= 40  # Eight steps.


@pytest.mark.parametrize("count", [1, 3, 4, 5, 1000])
def test_equal_points(reconstruct, count):
    result, surface = reconstruct(lines([[0.1, 0.2, 0.3]] * count))
    assert (result.returncode, surface["points"], surface["nodes"]) == (0, count, 1)
    assert surface["fits"] + surface["segments"] + surface["loose_points"] == 1
    assert surface["verify"]["holds"]
