# SPDX-License-Identifier: Apache-2.0
"""The audit: a small table from the command line, its files and sums, going on where it stopped, one run folder scored."""

import json
import os
import pty
import signal
import subprocess
import time
import xml.etree.ElementTree

import pytest

SMALL = ["--starts", 1, "--targets", 2000, "--candidates", 150, "--walls", 1000]
TABLE = ["audit", "planar", "discs", *SMALL, "--variants", "default,optimistic,sight", "--to-the-end"]
MEASURES = ["n90", "n95", "n99", "missed", "runs", "ratio_n95", "ratio_n99", "ratio_n99_walls", "worst_n99", "idle", "picks", "path_m", "time_s", "verdicts"]


def results(folder):
    """All files of an audit but the seconds."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file() and p.parent.name != "seconds" and p.name != "timing.json"}


@pytest.fixture(scope="module")
def table(vantage, tmp_path_factory):
    folder = tmp_path_factory.mktemp("audit") / "table"
    result = vantage(*TABLE, "-o", folder)
    assert result.returncode == 0, result.stderr
    assert len(result.stderr.splitlines()) == 6  # One a run.
    assert result.stdout.splitlines()[-1] == str(folder / "report.html")
    return folder


def test_measures_of_a_small_table(table):
    audit = json.loads((table / "audit.json").read_text())
    assert audit["complete"] and [scene["scene"] for scene in audit["scenes"]] == ["planar", "discs"]
    assert list(audit["all"]) == ["default", "optimistic", "sight"]
    for scene in audit["scenes"]:
        (start,) = scene["starts"]
        assert len(scene["runs"]) == 3 and set(scene["oracles"]) == {"anywhere", "seen", "walls"}
        for name, sums in scene["variants"].items():
            assert set(MEASURES) <= set(sums)
            (run,) = [run for run in scene["runs"] if run["variant"] == name]
            oracles = run["oracles"]
            used = run["n99"] or run["cap"]
            assert run["cap"] == 3 * oracles["anywhere"]["n99"]
            assert sums["ratio_n99"] == sums["worst_n99"] == pytest.approx(used / oracles["anywhere"]["n99"])
            assert sums["ratio_n99_walls"] == pytest.approx(used / oracles["walls"]["n99"])
            assert oracles["anywhere"]["n99"] <= oracles["walls"]["n99"]
            bound = oracles["bound"]
            assert bound["relaxation"] - 1e-6 <= bound["n99"] <= bound["best"] <= oracles["anywhere"]["n99"]
            assert bound["proven"] == (bound["n99"] == bound["best"]) and len(start["oracles"]["bound"]["places"]) == bound["best"]
            assert start["oracles"]["bound"]["places"][0] == start["place"]
            assert sums["ratio_n99_bound"] == pytest.approx(used / bound["n99"]) and sums["ratio_n99_best"] == pytest.approx(used / bound["best"])
            assert sums["coverage"] == run["coverage"] and sums["missed"] == (run["n99"] is None)
            if run["n99"]:  # All up to 99 %: the definition, by hand.
                assert run["coverage"][run["n99"] - 1] >= 0.99 > max(run["coverage"][: run["n99"] - 1])
                assert run["picks"] == run["n99"] - 1
                gains = [b - a for a, b in zip(run["coverage"], run["coverage"][1 : run["n99"]])]
                assert run["idle"] == sum(gain < 0.001 for gain in gains)
                assert run["path_m"] == run["way_m"][run["n99"] - 1]
            scans = run["picks"] + 1
            assert run["time_s"]["walk"] == pytest.approx(run["path_m"] + 120 * scans)
            assert run["time_s"]["drone"] == pytest.approx(run["path_m"] / 2 + 2 * scans)
            assert run["places"][0] == start["place"] == start["oracles"]["anywhere"]["places"][0]
            assert oracles["walls"]["n99"] == start["oracles"]["walls"]["n99"]
            assert run["surface"] == sorted(run["surface"]) and 0 < run["surface_share"] == run["surface"][-1] <= 1
            assert run["false_free_m3"] >= 0 and run["false_hidden_m3"] >= 0 and run["thin_recall"] is None
            assert run["verdict"]["right"] in (True, False) if run["verdict"]["finished"] else run["verdict"]["right"] is None
    # The planner as it stands is no random walk.
    assert audit["all"]["default"]["missed"] == 0 and audit["all"]["default"]["ratio_n99"] <= 2


def test_second_call_plays_nothing_and_says_the_same(vantage, table):
    before = results(table)
    begin = time.monotonic()
    again = vantage(*TABLE, "-o", table, "--json")
    assert (again.returncode, again.stderr) == (0, "")
    assert time.monotonic() - begin < 5
    assert results(table) == before
    assert again.stdout.encode() == before["audit.json"]


def test_missing_runs_are_played_again_to_the_same_bytes(vantage, table, tmp_path):
    before = results(table)
    runs = sorted((table / "runs").iterdir())
    runs[1].unlink()
    runs[4].unlink()
    sorted((table / "oracles").iterdir())[0].unlink()
    again = vantage(*TABLE, "-o", table, "--threads", 1, "--curves")
    assert again.returncode == 0 and len(again.stderr.splitlines()) == 2
    assert "  at " in again.stdout
    assert results(table) == before


def test_ctrl_c_keeps_what_is_finished(vantage, table, tmp_path):
    folder = tmp_path / "stopped"
    program = str(vantage("--version").args[0])
    process = subprocess.Popen([program, *map(str, TABLE), "-o", str(folder)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    process.stderr.readline()  # The first run is finished.
    process.send_signal(signal.SIGINT)
    rest = process.communicate(timeout=60)[1]
    assert process.returncode == 130 and rest.splitlines()[-1] == "vantage: stopped; the same command goes on"
    part = json.loads((folder / "audit.json").read_text())
    assert not part["complete"] and 0 < len(list((folder / "runs").iterdir())) < 6
    assert vantage(*TABLE, "-o", folder, "-q").returncode == 0
    assert results(folder) == results(table)


def test_report_is_one_page_without_network(table):
    page = (table / "report.html").read_text()
    assert "http" not in page.replace("http://www.w3.org", "") and "<script" not in page
    for name in ("default", "optimistic", "sight", "oracle, walls", "planar", "discs"):
        assert name in page
    xml.etree.ElementTree.fromstring(page.replace("<!DOCTYPE html>", "").replace("\u00a0", " "))


def test_own_variant_and_layouts(vantage, tmp_path):
    own = ["--variant", "calm=planner.lambda_factor=1,planner.rays=200", "--set", "explore.seed=7"]
    result = vantage("audit", "planar:blobs=2", *SMALL, "--layouts", 2, *own, "-o", tmp_path / "own", "--json")
    assert result.returncode == 0, result.stderr
    audit = json.loads(result.stdout)
    (scene,) = audit["scenes"]
    assert scene["layouts"] == ["planar:blobs=2,seed=1", "planar:blobs=2,seed=2"] and len(scene["runs"]) == 2
    assert audit["plan"]["variants"] == {"calm": {"what": "planner.lambda_factor=1,planner.rays=200", "settings": {"planner.lambda_factor": "1", "planner.rays": "200"}}}
    assert audit["plan"]["settings"] == {"explore.seed": "7"}


def test_without_a_bound(vantage, tmp_path):
    result = vantage("audit", "planar", *SMALL, "--variants", "nearest", "--bound", 0, "-o", tmp_path / "none", "--json")
    assert result.returncode == 0, result.stderr
    audit = json.loads(result.stdout)
    assert audit["scenes"][0]["starts"][0]["oracles"]["bound"] is None and audit["all"]["nearest"]["ratio_n99_bound"] is None
    (run,) = json.loads((tmp_path / "none" / "timing.json").read_text())["scenes"][0]["runs"]
    assert 1 < run["memory_before_mib"] <= run["peak_memory_mib"] < 4000 and run["cpu_seconds"] > 0


def test_information_gain_where_octomap_is(vantage, tmp_path):
    result = vantage("audit", "planar:blobs=2", *SMALL, "--variants", "octomap", "--cap", 2, "-o", tmp_path / "peer", "--json")
    if result.returncode == 2:
        assert result.stderr.splitlines() == ["vantage: --variants: octomap: this build has no OctoMap (liboctomap-dev)"]
        assert not (tmp_path / "peer").exists()
        return
    assert result.returncode == 0, result.stderr
    (run,) = json.loads(result.stdout)["scenes"][0]["runs"]
    assert run["variant"] == "octomap" and len(run["coverage"]) >= 2


def test_live_line_on_a_terminal(vantage, table):
    """Shown while it goes, and taken away at the end."""
    program = str(vantage("--version").args[0])
    sorted((table / "runs").iterdir())[0].unlink()
    head, tail = pty.openpty()
    process = subprocess.Popen([program, *map(str, TABLE), "-o", str(table)], stdout=subprocess.DEVNULL, stderr=tail)
    os.close(tail)
    shown = b""
    try:
        while more := os.read(head, 65536):
            shown += more
    except OSError:
        pass
    assert process.wait() == 0
    assert b" of 6  discs:seed=1 start 0 default" in shown and b"scan 2" in shown
    assert shown.endswith(b"\r\x1b[K")


def test_a_run_folder_is_scored(vantage, tmp_path):
    run = tmp_path / "run"
    assert vantage("explore", "wires", "--voxel", 1, "--step-deg", 2, "--max-scans", 3, "-o", run, "-q").returncode == 0
    result = vantage("audit", run, "--truth", "wires", "--json", *SMALL[2:], "--variants", "optimistic")
    assert result.returncode == 0, result.stderr
    score = json.loads(result.stdout)
    assert {"ratio_n95", "ratio_n99", "oracles", "baselines", "coverage", "false_free_m3", "thin_recall"} <= set(score)
    steps = json.loads((run / "result.json").read_text())["steps"]
    assert score["scans"] == 3 == len(score["coverage"])
    assert score["places"] == [step["vantage"] for step in steps]
    assert score["coverage"] == sorted(score["coverage"])
    assert 0.9 < score["thin_recall"] <= 1.0
    for name, of in [("ratio_n95", "anywhere"), ("ratio_n99", "anywhere"), ("ratio_n99_walls", "walls")]:
        ours, theirs = score[name.split("_")[1]], score["oracles"][of][name.split("_")[1]]
        assert score[name] == (pytest.approx(ours / theirs) if ours and theirs else None)
    assert list(score["baselines"]) == ["optimistic"] and score["baselines"]["optimistic"]["coverage"][0] == score["coverage"][0]
    assert vantage("audit", run, "--json", *SMALL[2:], "--variants", "optimistic").stdout == result.stdout  # Its own scene is the truth.
    text = vantage("audit", run, *SMALL[2:], "--variants", "none")
    assert text.returncode == 0 and text.stdout.splitlines()[0].startswith("wires: 3 scans, ")
