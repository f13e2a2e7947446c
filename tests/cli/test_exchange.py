# SPDX-License-Identifier: Apache-2.0
"""Two vehicles publish, exchange and merge maps."""

import hashlib
import itertools
import json

import pytest


@pytest.fixture(scope="module")
def scans(vantage, tmp_path_factory):
    """Clouds of a room of a plan, from four places."""
    folder = tmp_path_factory.mktemp("scans")
    for i, place in enumerate(("0,0,2", "5,3,2", "-4,2,2", "8,-3,2")):
        result = vantage("scan", "patio", "--at", place, "-o", folder / f"{i}.ply", "-q")
        assert result.returncode == 0, result.stderr
    return folder


def publish(vantage, target, *arguments):
    result = vantage("publish", *arguments, "-o", target, "--json")
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


def test_vehicles_end_with_equal_hashes_whatever_the_order(vantage, scans, tmp_path):
    names = ("car", "bus", "drone")
    for name, clouds in zip(names, (("0", "1"), ("1", "2"), ("3",))):
        figures = publish(vantage, tmp_path / f"{name}.vmap", *(scans / f"{c}.ply" for c in clouds), "--eta", "0.2")
        assert figures["deltas"] == len(clouds) and list(figures["sources"]) == [name]
        assert max(figures["data_to_surface_m"], figures["surface_to_data_m"]) <= 0.2
    hashes = set()
    for i, order in enumerate(itertools.permutations(names)):
        target = tmp_path / f"all{i}.vmap"
        merged = vantage("merge", *(tmp_path / f"{name}.vmap" for name in (*order, order[0])), "-o", target, "--json")
        figures = json.loads(merged.stdout)
        assert figures["sha256"] == hashlib.sha256(target.read_bytes()).hexdigest()
        assert figures == json.loads(vantage("info", target, "--json").stdout)
        hashes.add(figures["sha256"])
    assert len(hashes) == 1
    # Only what is missing need be sent.
    assert vantage("merge", tmp_path / "all0.vmap", "--without", tmp_path / "car.vmap", "-o", tmp_path / "news.vmap").returncode == 0
    assert vantage("merge", tmp_path / "news.vmap", tmp_path / "car.vmap", "-o", tmp_path / "again.vmap").returncode == 0
    assert (tmp_path / "again.vmap").read_bytes() == (tmp_path / "all0.vmap").read_bytes()
    assert vantage("merge", tmp_path / "all0.vmap", "--without", tmp_path / "all1.vmap", "-o", tmp_path / "none.vmap").returncode == 0
    assert json.loads(vantage("info", tmp_path / "none.vmap", "--json").stdout)["deltas"] == 0


def test_going_on_is_the_same_as_all_at_once(vantage, scans, tmp_path):
    for name, threads in (("first", 1), ("once", 2)):
        clouds = [scans / "0.ply"] if name == "first" else [scans / "0.ply", scans / "1.ply"]
        publish(vantage, tmp_path / f"{name}.vmap", *clouds, "--source", "car", "--threads", threads)
    publish(vantage, tmp_path / "first.vmap", scans / "1.ply", "--source", "car", "--onto", tmp_path / "first.vmap")
    assert (tmp_path / "first.vmap").read_bytes() == (tmp_path / "once.vmap").read_bytes()


def test_a_missing_delta_is_named(vantage, scans, tmp_path):
    publish(vantage, tmp_path / "one.vmap", scans / "0.ply", "--source", "car")
    publish(vantage, tmp_path / "two.vmap", scans / "0.ply", scans / "1.ply", "--source", "car")
    assert vantage("merge", tmp_path / "two.vmap", "--without", tmp_path / "one.vmap", "-o", tmp_path / "late.vmap").stdout.count("1 earlier delta") == 1


def test_surfaces_come_back(vantage, scans, tmp_path):
    figures = publish(vantage, tmp_path / "car.vmap", scans / "0.ply", "--eta", "0.2")
    for extension in ("ply", "glb"):
        assert vantage("merge", tmp_path / "car.vmap", "-o", tmp_path / f"car.{extension}").returncode == 0
    surface = json.loads(vantage("info", tmp_path / "car.ply", "--json").stdout)
    assert surface["kind"] == "surface" and figures["polygons"] > 0
    assert [surface[k] for k in ("polygons", "segments", "points")] == [figures[k] for k in ("polygons", "segments", "points")]
    assert surface["certified_m"] <= 0.2 + 1e-6


def test_maps_of_the_plane(vantage, tmp_path):
    assert vantage("scan", "planar", "--at", "2,2", "-o", tmp_path / "flat.xyz", "-q").returncode == 0
    figures = publish(vantage, tmp_path / "flat.vmap", tmp_path / "flat.xyz", "--eta", "0.1")
    assert figures["dim"] == 2 and figures["segments"] > 0
    (tmp_path / "space.xyz").write_text("1 2 3\n")
    publish(vantage, tmp_path / "space.vmap", tmp_path / "space.xyz")
    refused = vantage("merge", tmp_path / "flat.vmap", tmp_path / "space.vmap", "-o", tmp_path / "both.vmap")
    assert refused.returncode == 2 and "space.vmap: a map of 3 dimensions beside one of 2" in refused.stderr
    assert not (tmp_path / "both.vmap").exists()
