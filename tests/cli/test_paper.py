# SPDX-License-Identifier: Apache-2.0
"""The paper's table made again, and the certificate checked from the command line."""

import json

import pytest


def test_table1_comes_in_files_and_on_the_terminal(vantage, tmp_path):
    result = vantage("paper", "table1", "--step-deg", 4, "-o", tmp_path / "table1")
    assert (result.returncode, result.stderr) == (0, "")
    folder = tmp_path / "table1"
    assert sorted(p.name for p in folder.iterdir()) == ["table1-church.png", "table1-patio.png", "table1.json", "table1.md"]
    assert (folder / "table1.md").read_text() == result.stdout
    assert (folder / "table1-patio.png").read_bytes().startswith(b"\x89PNG")
    again = vantage("paper", "table1", "--step-deg", 4, "--json", "--threads", 1)
    assert (again.returncode, again.stderr) == (0, "")
    assert again.stdout == (folder / "table1.json").read_text()
    rows = json.loads(again.stdout)["rows"]
    assert [(row["domain"], row["rules"]) for row in rows] == [(domain, rules) for domain in ("patio", "church") for rules in ("paper", "surface.paper = true", "surface.paper = false")]
    assert [row["fits"] for row in rows if row["rules"] == "paper"] == [1370, 11099]
    for row in rows:
        if row["rules"] == "paper":
            assert row["eta_m"] is None
        else:
            assert row["eta_m"] == pytest.approx(row["eta"] * row["side_m"])


@pytest.fixture(scope="module")
def cloud(vantage, tmp_path_factory):
    path = tmp_path_factory.mktemp("cloud") / "wires.ply"
    assert vantage("scan", "wires", "--at", "20,4,1.6", "--step-deg", 2, "-o", path, "-q").returncode == 0
    return path


def test_verify_says_that_the_certificate_holds(vantage, cloud):
    result = vantage("reconstruct", cloud, "--verify", "--json")
    assert (result.returncode, result.stderr) == (0, "")
    surface = json.loads(result.stdout)
    verify, hausdorff = surface["verify"], surface["hausdorff"]
    assert verify["holds"] and verify["faults"] == [] and verify["points"] == surface["points"]
    assert verify["patches"] == surface["fits"] + surface["segments"] + surface["loose_points"]
    for side in ("data_to_surface", "surface_to_data"):
        assert verify[side]["certified_m"] == hausdorff[side + "_m"]
        assert verify[side]["max_at_least_m"] <= hausdorff[side + "_m"] <= surface["eta_m"]
        assert verify[side]["mean_m"] <= verify[side]["max_m"]
    text = vantage("reconstruct", cloud, "--verify").stdout.splitlines()
    assert text[1].startswith("verified: ") and len(text) >= 4
    assert vantage("reconstruct", cloud, "--verify", "-q").stdout == ""


def test_verify_of_the_papers_rules(vantage, cloud):
    """They lose points and say so: the certificate is bad, not wrong."""
    result = vantage("reconstruct", cloud, "--verify", "--paper", "--json")
    assert result.returncode == 0
    verify = json.loads(result.stdout)["verify"]
    assert verify["holds"] and verify["data_to_surface"]["max_m"] > 1.0
