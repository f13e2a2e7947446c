# SPDX-License-Identifier: Apache-2.0
"""vantage next in the open, on clouds of hits alone: nothing is known of the sky, and it is not waited for."""

import math

import pytest
from next_scenes import COARSE, ask, at, write_slabs

DOMAIN = (-10, -8, -1, 10, 8, 6)  # With as much sky above the walls as below their tops.
ROUNDS = 5


@pytest.fixture(scope="module")
def yard(tmp_path_factory):
    """Level ground with three boxes on it that hide each other."""
    path = tmp_path_factory.mktemp("yard") / "yard.obj"
    slabs = [((-12, -12, -1), (12, 12, 0)), ((-5, 1, 0), (-2, 4, 2.5)), ((3, 0, 0), (5, 5, 2)), ((-1, -6, 0), (4, -4, 2.5))]
    write_slabs(path, slabs)
    return path


def hits(vantage, scene, place, path, noise):
    """A scan without the rays that met nothing; noise in metres."""
    result = vantage("scan", scene, "--step-deg", 2, "--at", at(place), "--noise", noise, "-o", path, "-q")
    assert result.returncode == 0, result.stderr
    return path


def test_nothing_is_expected_of_the_sky(vantage, yard, tmp_path):
    run, place, before = tmp_path / "run", [0.0, 0.0, 1.6], None
    for number in range(ROUNDS):
        scan = hits(vantage, yard, place, tmp_path / f"{number}.ply", noise=0.005)
        named = [run, scan] if number else [scan, "-o", run, "--domain", at(DOMAIN), "--height", 1.6, "--voxel", 0.5, "--eta", 0.1]
        result = ask(vantage, *named, "--at", at(place), codes=(0, 6))
        low, high = result["coverage"]["elevation_deg"]
        assert result["coverage"]["by_hits"] and low < -60 and high < 70
        beyond = result["coverage"]["out_of_scope_m3"]  # Later scans, from afar, see over the first ones.
        assert beyond > 0 or number > 0
        assert any("out of scope" in note for note in result["notes"]) == (beyond > 0)
        # A sphere of directions would promise hundreds of cubic metres of sky, again and again.
        if before:
            assert result["seen_m3"] - before["seen_m3"] > 0.1 * before["ranked"][0]["new_volume_m3"] - 5
        before, place = result, [round(x, 3) for x in result["vantage"]]
    assert before["ranked"][0]["new_volume_m3"] < 0.1 * before["seen_m3"]


def test_level_ground_is_not_taken_for_the_same_scan(vantage, yard, tmp_path):
    """Seen from the scanner, flat ground without noise is the same from everywhere."""
    scans = [hits(vantage, yard, place, tmp_path / f"{place[0]}.ply", noise=0) for place in ((-9, -9, 1.6), (9, -9, 1.6))]
    ask(vantage, *scans, "--at", "-9,-9,1.6", "--at", "9,-9,1.6", "--voxel", 0.5, "--eta", 0.1)
    moved = vantage("next", scans[0], scans[0], "--at", "-9,-9,1.6", "--at", "9,-9,1.6", "--voxel", 0.5, "--eta", 0.1)
    assert moved.returncode == 2 and "a scan counts once" in moved.stderr


def test_the_height_does_not_creep_up(vantage, yard, tmp_path):
    """Where each station is taken as proposed, ten rounds later the scanner still stands as high above the ground as at first."""
    places, scans = [[0.0, 0.0, 1.6]], []
    for number in range(10):
        result = vantage("scan", yard, "--step-deg", 3, "--at", at(places[-1]), "--noise", 0.01, "--seed", number, "-o", tmp_path / f"{number}.ply", "-q")
        assert result.returncode == 0, result.stderr
        scans.append(tmp_path / f"{number}.ply")
        poses = [x for place in places for x in ("--at", at(place))]
        result = ask(vantage, *scans, *poses, "--domain", at(DOMAIN), "--voxel", 0.5, "--eta", 0.1, codes=(0, 6))
        assert len(result["ranked"]) > 1, number
        for place in result["ranked"]:
            assert place["vantage"][2] == pytest.approx(1.6, abs=0.25), number
        places.append([round(x, 3) for x in result["vantage"]])


def test_a_loop_beside_a_bench_goes_on(vantage, tmp_path):
    """A station that nearly touches a bench stands on the ground, not on the bench, from where no way leads on."""
    scene = tmp_path / "bench.obj"
    write_slabs(scene, [((-12, -12, -1), (12, 12, 0)), ((-3, 0, 0), (-0.55, 0.5, 0.55)), ((3, 0, 0), (5, 5, 2))])
    place = [-1.5, -0.1, 1.6]  # The cell right below is the bench's.
    scan = hits(vantage, scene, place, tmp_path / "scan.ply", noise=0.005)
    result = ask(vantage, scan, "--at", at(place), "--domain", "-7,-6,-1,7,6,4", *COARSE)
    assert len(result["ranked"]) == 5
    for found in result["ranked"]:
        assert math.hypot(found["vantage"][0] - place[0], found["vantage"][1] - place[1]) > 2
        assert found["vantage"][2] == pytest.approx(1.6, abs=0.25)


def test_of_unknown_directions_nothing_is_expected(vantage, tmp_path):
    """On bare ground with a wall in the north: what is unseen in the south, above the ground, no scan can show."""
    scene, place = tmp_path / "wall.obj", [0.0, 0.0, 1.6]
    write_slabs(scene, [((-12, -12, -1), (12, 12, 0)), ((-9, 4, 0), (9, 5, 5))])
    scan = hits(vantage, scene, place, tmp_path / "scan.ply", noise=0)
    common = ("--domain", at(DOMAIN), "--voxel", 0.5, "--eta", 0.1, "--no-return", "unknown")
    before = ask(vantage, scan, "--at", at(place), *common, codes=(0, 6))
    assert any("in every direction" in note for note in before["notes"])
    for best in before["ranked"]:
        again = hits(vantage, scene, best["vantage"], tmp_path / "again.ply", noise=0)
        after = ask(vantage, scan, again, "--at", at(place), "--at", at(best["vantage"]), *common, codes=(0, 6))
        assert best["new_volume_m3"] < 3 * (after["seen_m3"] - before["seen_m3"]) + 3
