# SPDX-License-Identifier: Apache-2.0
"""The paper's figures made again, in their quick versions: numbers, pictures, and what happens when one is stopped."""

import json
import signal
import subprocess
import time
from pathlib import Path

import pytest

FORMULAS = ["printed", "repaired", "sight", "default"]
PICTURES = {
    "fig2": ["fig2-default.png", "fig2-printed.png", "fig2-repaired.png", "fig2-sight.png", "fig2.png"],
    "fig3": ["fig3.png"],
    "fig4": ["fig4.png"],
    "fig5": ["fig5.png"],
    "fig6": ["fig6.png"],
    "fig7": ["fig7.png"],
}


@pytest.fixture(scope="module")
def figure(vantage, tmp_path_factory):
    """Runs `paper NAME --quick -o DIR` once and gives its folder, text and numbers."""
    done = {}

    def make(name):
        if name not in done:
            folder = tmp_path_factory.mktemp("figures") / name
            result = vantage("paper", name, "--quick", "--step-deg", 4, "-o", folder)
            assert (result.returncode, result.stderr) == (0, "")
            done[name] = folder, result.stdout, json.loads((folder / f"{name}.json").read_text())
        return done[name]

    return make


@pytest.mark.parametrize("name", PICTURES)
def test_folder_holds_pictures_and_numbers(figure, name):
    folder, text, numbers = figure(name)
    assert sorted(p.name for p in folder.iterdir()) == sorted([*PICTURES[name], f"{name}.json", f"{name}.md"])
    assert (folder / f"{name}.md").read_text() == text
    assert numbers["figure"] == name and "paper" in numbers
    for picture in PICTURES[name]:
        data = (folder / picture).read_bytes()
        width, height = int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")
        assert data.startswith(b"\x89PNG") and 600 <= width <= 1700 and 400 <= height <= 1700
        assert 8_000 < len(data) < 200_000
    assert text.count("\n| ") >= 3


@pytest.mark.parametrize("name", ["fig2", "fig3", "fig4"])
def test_formulas_stand_beside_each_other(figure, name):
    rows = figure(name)[2]["rows"]
    assert [row["formula"] for row in rows] == FORMULAS
    assert len({row["label"] for row in rows}) == len(FORMULAS)


@pytest.mark.parametrize("name", ["fig2", "fig3", "fig5", "fig7"])
def test_coverage_begins_alike_and_grows(figure, name):
    rows = figure(name)[2]["rows"]
    curves = [row["coverage"][0] if name == "fig2" else row["coverage"] for row in rows]
    assert len({curve[0] for curve in curves[:4]}) == 1  # The same first scan.
    for curve in curves:
        assert 0.1 < curve[0] <= max(curve) <= 1.0
        assert all(after >= before - 0.01 for before, after in zip(curve, curve[1:]))  # What was free may turn out to be an obstacle.


def test_line_through_the_cylinders_is_least_squares(figure):
    for row in figure("fig4")[2]["rows"]:
        n = [scene["cylinders"] for scene in row["scans"]]
        y = [scene["mean"] for scene in row["scans"]]
        assert n == [1, 2, 3] and all(2 <= value <= 16 for value in y)
        assert row["slope"] == pytest.approx((y[2] - y[0]) / 2, abs=1e-9)  # Of three even places.
        assert row["intercept"] == pytest.approx(sum(y) / 3 - 2 * row["slope"], abs=1e-9)
        assert row["decay"][0] == 1.0 and len(row["decay"]) == len(row["coverage"])


def test_sites_say_what_the_paper_had(figure):
    patio, church = figure("fig5")[2], figure("fig7")[2]
    assert patio["paper"]["points"] == 1769061 and church["paper"]["points"] == 1896786
    assert "1,896,786" in figure("fig7")[1]
    assert [row["formula"] for row in patio["rows"]] == [*FORMULAS, "default+cones"]
    assert patio["surface"]["eta_m"] == pytest.approx(0.4) and patio["voxel_m"] == pytest.approx(2 / 3)


def test_things_of_the_patio_are_found(figure):
    numbers = figure("fig6")[2]
    assert {kind["kind"] for kind in numbers["found"]} == {"tree", "column", "furniture", "wall", "house"}
    assert all(0.0 <= kind["share"] <= 1.0 and 0.0 <= kind["apart"] <= 1.0 for kind in numbers["found"])
    off = numbers["surface_to_truth_m"]
    assert 0.0 < off["mean"] <= off["p95"] <= off["max"]


def test_numbers_do_not_depend_on_threads(vantage, figure):
    alone = vantage("paper", "fig3", "--quick", "--step-deg", 4, "--json", "--threads", 1)
    assert (alone.returncode, alone.stderr) == (0, "")
    assert json.loads(alone.stdout) == figure("fig3")[2]


@pytest.mark.parametrize(
    "arguments, words",
    [
        (["fig1"], "fig1"),
        ([], "NAME is missing"),
        (["fig2", "--step-deg", "100"], "step_deg"),
        (["fig4", "--threads", "0"], "--threads"),
    ],
)
def test_wrong_input_is_one_line(vantage, arguments, words):
    result = vantage("paper", *arguments)
    assert result.returncode == 2 and result.stdout == ""
    assert result.stderr.count("\n") == 1 and words in result.stderr


def test_ctrl_c_stops_and_leaves_no_files(vantage, tmp_path):
    folder = tmp_path / "fig4"
    program = vantage("--version").args[0]
    process = subprocess.Popen([program, "paper", "fig4", "-o", str(folder)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not folder.exists():  # It is made when the work begins.
        time.sleep(0.02)
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130 and out == "" and err.count("\n") == 1 and "stopped" in err
    assert list(Path(folder).iterdir()) == []
