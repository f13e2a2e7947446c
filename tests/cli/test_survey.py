# SPDX-License-Identifier: Apache-2.0
"""Surveys of known places from the command line."""

import csv
import json

import pytest

QUICK = ("--samples", 600, "--candidates", 200, "--effort", 5)


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def folder(vantage, tmp_path_factory):
    folder = tmp_path_factory.mktemp("survey") / "office"
    result = vantage("survey", "office", *QUICK, "-o", folder)
    assert (result.returncode, result.stderr) == (0, "")
    assert "stations" in result.stdout and result.stdout.endswith(f"report: {folder}/report.html\n")
    return folder


def test_files_say_the_same(vantage, folder):
    assert sorted(p.name for p in folder.iterdir()) == ["path.csv", "report.html", "stations.csv", "survey.json"]
    figures = json.loads((folder / "survey.json").read_text())
    stations, path = rows(folder / "stations.csv"), rows(folder / "path.csv")
    assert len(stations) == figures["stations"] == len(figures["places"])
    assert 1 < figures["at_least"] <= figures["stations"] and figures["at_least"] - 1 < figures["bound"] <= figures["at_least"] + 1e-6
    assert figures["share"] == 1.0 and figures["wall"] == pytest.approx(sum(float(s["adds"]) for s in stations))
    for k, (station, place) in enumerate(zip(stations, figures["places"])):
        assert [float(station["x"]), float(station["y"])] == pytest.approx(place["place"])
        last = [p for p in path if int(p["leg"]) == k][-1]
        assert [float(last["x"]), float(last["y"])] == pytest.approx(place["place"])
    again = vantage("survey", "office", *QUICK, "--json", "--threads", 1)
    assert (again.returncode, again.stderr) == (0, "")
    assert again.stdout == (folder / "survey.json").read_text()


def test_page_is_whole_and_needs_no_network(folder):
    page = (folder / "report.html").read_text()
    assert page.rstrip().endswith("</html>") and "data:image/png;base64," in page
    assert "http://" not in page.replace("http://www.w3.org", "") and "https://" not in page


def test_limits_in_space(vantage):
    result = vantage("survey", "floor:rooms=12", *QUICK, "--incidence-deg", 70, "--share", 0.9, "--height", 1.5, "--overlap", 0.1, "--return", "--json")
    assert (result.returncode, result.stderr) == (0, "")
    figures = json.loads(result.stdout)
    assert figures["dim"] == 3 and figures["share"] >= 0.9 and figures["at_least"] <= figures["stations"]
    for station in figures["places"]:
        assert station["place"][2] == pytest.approx(1.5, abs=0.151)
    if figures["linked"]:
        assert all(station["overlap"] >= 0.1 for station in figures["places"][1:])


@pytest.mark.parametrize("arguments, says", [
    ((), "SCENE is missing"),
    (("office", "--cover", "0"), "--cover"),
    (("office", "--overlap", "1.5"), "--overlap"),
    (("office", "--incidence-deg", "steep"), "--incidence-deg"),
    (("office", "--density", "-1"), "--density"),
    (("office", "--share", "0"), "--share"),
    (("office", "--min-range", "90"), "--min-range"),
    (("office", "--height", "-1"), "--height"),
    (("office", "--overlaps", "0.2"), "--overlap"),
    (("floor:rooms=12", "--height", "2.75", *QUICK), "survey.height"),
    (("office", "--height", "1"), "--height"),
    (("nowhere",), "nowhere"),
])  # fmt: skip
def test_wrong_input_is_one_line(vantage, arguments, says):
    result = vantage("survey", *arguments)
    assert (result.returncode, result.stdout) == (2, "")
    assert says in result.stderr and len(result.stderr.splitlines()) == 1


def test_a_folder_that_cannot_be_made(vantage, tmp_path):
    (tmp_path / "file").write_text("")
    result = vantage("survey", "office", *QUICK, "-o", tmp_path / "file")
    assert result.returncode == 3 and len(result.stderr.splitlines()) == 1
