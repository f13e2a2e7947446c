# SPDX-License-Identifier: Apache-2.0
"""The limit on the incidence angle of vantage next: walls that were only seen flat are named, and the next station faces them."""

import math

import pytest
from next_scenes import COARSE, ask, at, write_slabs

HERE = (1, 1, 1.5)


@pytest.fixture(scope="module")
def base(vantage, tmp_path_factory):
    """A corridor, 16 x 2 x 3 m, seen from its end: all of it, and most of its walls at a grazing angle."""
    folder = tmp_path_factory.mktemp("corridor")
    slabs = [((-1, -1, -1), (17, 3, 0)), ((-1, -1, 3), (17, 3, 4)), ((-1, -1, 0), (0, 3, 3)), ((16, -1, 0), (17, 3, 3)),
             ((0, -1, 0), (16, 0, 3)), ((0, 2, 0), (16, 3, 3))]  # fmt: skip
    write_slabs(folder / "corridor.obj", slabs)
    result = vantage("scan", folder / "corridor.obj", "--step-deg", 1, "--at", at(HERE), "-o", folder / "scan.ply", "-q")
    assert result.returncode == 0, result.stderr
    return folder / "scan.ply", "--at", at(HERE), "--domain", "-0.5,-0.5,-0.5,16.5,2.5,3.5", *COARSE


def test_the_next_station_faces_what_was_seen_flat(vantage, base):
    free = ask(vantage, *base)
    assert free["flat"] is None and all(place["mended_m2"] == 0 for place in free["ranked"])
    answer = ask(vantage, *base, "--incidence-deg", 60)
    flat = answer["flat"]
    assert flat["limit_deg"] == 60 and 10 < flat["area_m2"] < 2 * 16 * 3 + 2 * 16 * 2
    assert flat["regions"] and all(60 < region["incidence_deg"] < 90 for region in flat["regions"])
    assert sum(region["area_m2"] for region in flat["regions"]) <= flat["area_m2"] + 1e-9
    # A wall 1 m off is seen flatter than 60 degrees from sqrt(3) m along it on.
    assert min(region["box"][0][0] for region in flat["regions"]) > HERE[0] + math.sqrt(3) - 0.5
    best = answer["ranked"][0]
    assert best["mended_m2"] > 0.5 * flat["area_m2"], "most of it"
    assert best["vantage"][0] > HERE[0] + math.sqrt(3), "it stands before the flat part"


def test_a_tighter_limit_finds_more(vantage, base):
    areas = [ask(vantage, *base, "--incidence-deg", limit)["flat"]["area_m2"] for limit in (80, 60, 40)]
    assert areas[0] < areas[1] < areas[2]
    assert "flatter than 60 degrees" in vantage("next", *base, "--incidence-deg", 60).stdout


def test_what_was_mended_is_not_asked_for_again(vantage, base, tmp_path):
    run = tmp_path / "run"
    first = ask(vantage, *base, "--incidence-deg", 60, "-o", run)
    corridor = base[0].with_name("corridor.obj")
    place = first["ranked"][0]["vantage"]
    assert vantage("scan", corridor, "--step-deg", 1, "--at", at(place), "-o", tmp_path / "b.ply", "-q").returncode == 0
    second = ask(vantage, run, tmp_path / "b.ply", "--at", at(place))
    assert second["flat"]["limit_deg"] == 60
    assert math.dist(second["vantage"], place) > 1.5


@pytest.mark.parametrize("limit", ["0", "91", "-5", "flat"])
def test_wrong_limits_are_one_line(vantage, base, limit):
    result = vantage("next", *base, "--incidence-deg", limit)
    assert (result.returncode, result.stdout) == (2, "")
    assert "next.incidence_deg" in result.stderr and len(result.stderr.splitlines()) == 1
