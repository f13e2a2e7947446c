# SPDX-License-Identifier: Apache-2.0
"""Runs from the command line: the files and their formats, resumption to the same bytes, stopping, taking scans out."""

import json
import os
import pty
import signal
import struct
import subprocess
import xml.etree.ElementTree
import zlib

import pytest

FILES = ["belief.vti", "manifest.json", "path.csv", "report.html", "result.json", "scans.log", "scenario.toml", "stations.csv", "steps.csv", "surface.glb", "surface.ply", "timing.json"]
SCENES = {"2d": ["discs", "--grid", "50"], "3d": ["pipes:cylinders=3", "--grid", "24", "--step-deg", "4"]}


def content(run):
    """All files of a run but timing.json, the one that may differ."""
    return {str(path.relative_to(run)): path.read_bytes() for path in run.rglob("*") if path.is_file() and path.name not in ("timing.json", "scans.log.bak")}


@pytest.fixture(scope="session", params=sorted(SCENES))
def scene(request):
    return SCENES[request.param]


@pytest.fixture(scope="session")
def straight(vantage, scene, tmp_path_factory):
    """A run of six scans, uninterrupted."""
    run = tmp_path_factory.mktemp("straight") / "run"
    result = vantage("explore", *scene, "--max-scans", 6, "-o", run, "-q")
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")
    return run


def test_every_file_is_there(straight):
    assert sorted(path.name for path in straight.iterdir() if path.is_file()) == FILES
    scans = json.loads((straight / "result.json").read_text())["scans"]
    assert sorted(path.name for path in (straight / "scans").iterdir()) == [f"{i:03}.ply" for i in range(scans)]
    assert len((straight / "stations.csv").read_text().splitlines()) == scans + 1
    assert len((straight / "steps.csv").read_text().splitlines()) == scans + 1


def test_resumed_run_ends_in_the_same_bytes(vantage, scene, straight, tmp_path):
    run = tmp_path / "run"
    assert vantage("explore", *scene, "--max-scans", 2, "-o", run, "-q").returncode == 0
    assert vantage("explore", "--resume", "--max-scans", 4, "-o", run, "-q").returncode == 0
    result = vantage("explore", *scene, "--resume", "--max-scans", 6, "-o", run, "--threads", 1, "--json", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert content(run) == content(straight)
    assert result.stdout == (straight / "result.json").read_text()


def test_any_number_of_threads_gives_the_same_bytes(vantage, scene, straight, tmp_path):
    for threads in (1, 2, 7):
        run = tmp_path / str(threads)
        assert vantage("explore", *scene, "--max-scans", 6, "-o", run, "-q", "--threads", threads).returncode == 0
        assert content(run) == content(straight)


def test_interrupted_run_saves_and_goes_on(vantage, tmp_path, straight, scene):
    program = vantage("--version").args[0]
    run = tmp_path / "run"
    process = subprocess.Popen([program, "explore", *scene, "--max-scans", "6", "-o", run], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    for line in process.stderr:  # One line a step.
        if line.startswith("scan   1"):
            break
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=120)
    if process.returncode == 0:
        pytest.skip("the run ended before the signal came")
    assert process.returncode == 130
    assert "vantage explore --resume -o" in out and out.splitlines()[-1].startswith("report: ")
    scans = json.loads((run / "result.json").read_text())["scans"]
    assert 2 <= scans < 6
    assert vantage("explore", "--resume", "--max-scans", 6, "-o", run, "-q").returncode == 0
    assert content(run) == content(straight)


def test_killed_run_goes_on(vantage, tmp_path, straight, scene):
    program = vantage("--version").args[0]
    run = tmp_path / "run"
    process = subprocess.Popen([program, "explore", *scene, "--max-scans", "6", "-o", run], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    for line in process.stderr:
        if line.startswith("scan   2"):
            break
    process.kill()
    process.communicate(timeout=60)
    assert vantage("explore", "--resume", "--max-scans", 6, "-o", run, "-q").returncode == 0
    assert content(run) == content(straight)


def test_torn_log_is_cut_and_damaged_log_refused(vantage, straight, tmp_path):
    run = tmp_path / "run"
    run.mkdir()
    whole = (straight / "scans.log").read_bytes()
    for name in ("scenario.toml", "manifest.json"):
        (run / name).write_bytes((straight / name).read_bytes())
    (run / "scans.log").write_bytes(whole[:-7])
    result = vantage("explore", "--resume", "--max-scans", 6, "-o", run)
    assert result.returncode == 0 and "cut off" in result.stderr
    assert content(run) == content(straight)
    damaged = bytearray(whole)
    damaged[200] ^= 1
    (run / "scans.log").write_bytes(damaged)
    result = vantage("explore", "--resume", "--max-scans", 6, "-o", run)
    assert result.returncode == 2 and len(result.stderr.splitlines()) == 1
    assert "scans.log:16: the scan log is damaged" in result.stderr


def test_one_process_at_a_time(vantage, scene, tmp_path):
    program = vantage("--version").args[0]
    run = tmp_path / "run"
    process = subprocess.Popen([program, "explore", *scene, "-o", run], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    for line in process.stderr:
        if line.startswith("scan"):
            break
    process.send_signal(signal.SIGSTOP)
    try:
        before = (run / "scans.log").read_bytes()
        for arguments in (["--resume"], [*scene, "--resume"], [*scene, "--force"], ["--resume", "--remove", 0]):
            result = vantage("explore", *arguments, "-o", run)
            assert result.returncode == 3 and result.stderr == f"vantage: {run}/scans.log: another process (pid {process.pid}) is writing this run\n"
        assert (run / "scans.log").read_bytes() == before and [path.name for path in tmp_path.iterdir()] == ["run"]
    finally:
        process.kill()
        process.communicate(timeout=60)


def test_a_run_stopped_before_its_first_scan_begins_again(vantage, scene, straight, tmp_path):
    for name, files in {"log": [], "scenario": ["scenario.toml"], "all": ["scenario.toml", "manifest.json"]}.items():
        run = tmp_path / name
        run.mkdir()
        (run / "scans.log").write_bytes((straight / "scans.log").read_bytes()[:16])
        (run / "scenario.toml.2147483647-1.part").write_bytes(b"[sc")
        for file in files:
            (run / file).write_bytes((straight / file).read_bytes())
        alone = vantage("explore", "--resume", "--max-scans", 6, "-o", run)
        assert alone.returncode == (0 if name == "all" else 2)
        assert name == "all" or alone.stderr == f"vantage: {run}: the run was stopped before its first scan: name its SCENE to begin again\n"
        assert vantage("explore", *scene, "--resume", "--max-scans", 6, "-o", run, "-q").returncode == 0
        assert content(run) == content(straight)


def test_remove_takes_a_scan_out(vantage, straight, tmp_path):
    run = tmp_path / "run"
    run.mkdir()
    for name in ("scenario.toml", "manifest.json", "scans.log"):
        (run / name).write_bytes((straight / name).read_bytes())
    assert vantage("explore", "--resume", "--remove", 1, "--remove", 4, "--max-scans", 4, "-o", run, "-q").returncode == 0
    places = [line.split(",")[1:4] for line in (run / "stations.csv").read_text().splitlines()[1:]]
    before = [line.split(",")[1:4] for line in (straight / "stations.csv").read_text().splitlines()[1:]]
    assert places == [before[i] for i in (0, 2, 3, 5)]
    assert (run / "scans.log.bak").read_bytes() == (straight / "scans.log").read_bytes()
    assert sorted(path.name for path in (run / "scans").iterdir()) == ["000.ply", "001.ply", "002.ply", "003.ply"]


def test_force_replaces(vantage, straight, tmp_path, scene):
    run = tmp_path / "run"
    assert vantage("explore", *scene, "--max-scans", 1, "-o", run, "-q").returncode == 0
    (run / "note.txt").write_text("mine")
    assert vantage("explore", *scene, "--max-scans", 6, "-o", run, "-q", "--force").returncode == 0
    assert content(run) == content(straight)
    assert [path.name for path in tmp_path.iterdir()] == ["run"]


def test_result_has_the_promised_keys(straight):
    result = json.loads((straight / "result.json").read_text())
    dim = result["dim"]
    verdict = result["verdict"]
    assert {"complete", "reason", "seen_fraction", "seen_fraction_bounds", "unseen"} <= verdict.keys()
    assert verdict["complete"] is False and verdict["reason"]
    low, high = verdict["seen_fraction_bounds"]
    assert 0 <= low <= verdict["seen_fraction"] <= high <= 1
    for region in verdict["unseen"]:
        assert region["volume_m3"] > 0 and region["reason"] and len(region["box"]) == 2 and all(len(corner) == dim for corner in region["box"])
    assert len(result["steps"]) == result["scans"]
    for number, step in enumerate(result["steps"]):
        assert {"scan", "vantage", "score", "candidates", "points", "seen_volume_m3", "seen_fraction", "path_m"} <= step.keys()
        assert step["scan"] == number and len(step["vantage"]) == dim
    surface = result["surface"]
    assert {"points", "depth", "nodes", "leaves", "fits", "segments", "loose_points", "eta_m", "hausdorff"} <= surface.keys()
    assert surface["leaves"] == (2**dim - 1) * (surface["nodes"] - surface["leaves"]) + 1
    assert 0 < surface["hausdorff"]["certified_m"] <= surface["eta_m"] * 1.001
    assert surface["hausdorff"]["certified_m"] == max(surface["hausdorff"]["data_to_surface_m"], surface["hausdorff"]["surface_to_data_m"])


def test_manifest_names_inputs_and_outputs(straight):
    manifest = json.loads((straight / "manifest.json").read_text())
    assert {"vantage", "scene", "seed", "inputs", "outputs"} <= manifest.keys()
    assert set(manifest["outputs"]) == set(content(straight)) - {"manifest.json", "scans.log"}
    for name, entry in manifest["outputs"].items():
        data = (straight / name).read_bytes()
        assert (entry["bytes"], entry["crc32"]) == (len(data), f"{zlib.crc32(data):08x}")


def test_log_is_what_the_header_says(straight):
    """An independent reader of scans.log: magic, version, dimension, and checksums by Python's zlib."""
    log = (straight / "scans.log").read_bytes()
    dim = json.loads((straight / "result.json").read_text())["dim"]
    assert log[:8] == b"VANTSCAN" and struct.unpack_from("<II", log, 8) == (1, dim)
    at, index = 16, 0
    while at < len(log):
        magic, length, payload_sum, head_sum = struct.unpack_from("<4sIII", log, at)
        payload = log[at + 16 : at + 16 + length]
        assert magic == b"SCAN" and zlib.crc32(log[at : at + 12]) == head_sum and zlib.crc32(payload) == payload_sum
        assert struct.unpack_from("<I", payload, 0)[0] == index
        (rays,) = struct.unpack_from("<Q", payload, 4 + 8 * (dim + dim * dim + 5))
        assert len(payload) == 4 + 8 * (dim + dim * dim + 5) + 8 + 4 * rays
        at, index = at + 16 + length, index + 1
    assert index == 6


def vti_arrays(path):
    """An independent reader of .vti: (nodes, {name: bytes})."""
    file = path.read_bytes()
    head, data = file.split(b"<AppendedData", 1)
    root = xml.etree.ElementTree.fromstring(head + b"</VTKFile>")
    assert root.attrib == {"type": "ImageData", "version": "1.0", "byte_order": "LittleEndian", "header_type": "UInt64", "compressor": "vtkZLibDataCompressor"}
    extent = [int(word) for word in root[0].attrib["WholeExtent"].split()]
    data = data[data.index(b"_") + 1 :]
    arrays = {}
    for array in root.iter("DataArray"):
        offset = int(array.attrib["offset"])
        blocks, block, last = struct.unpack_from("<3Q", data, offset)
        sizes = struct.unpack_from(f"<{blocks}Q", data, offset + 24)
        at = offset + 24 + 8 * blocks
        content = b""
        for number, size in enumerate(sizes):
            part = zlib.decompress(data[at : at + size])
            assert len(part) == (last if last and number == blocks - 1 else block)
            content += part
            at += size
        arrays[array.attrib["Name"]] = (array.attrib["type"], content)
    nodes = 1
    for axis in range(3):
        nodes *= extent[2 * axis + 1] - extent[2 * axis] + 1
    return nodes, arrays


def test_belief_opens_as_a_vtk_image(straight):
    nodes, arrays = vti_arrays(straight / "belief.vti")
    assert {name: kind for name, (kind, _) in arrays.items()} == {"state": "UInt8", "psi": "Float32", "E": "Float32"}
    state, psi = arrays["state"][1], struct.unpack(f"<{nodes}f", arrays["psi"][1])
    assert len(state) == nodes and len(arrays["E"][1]) == 4 * nodes
    assert set(state) <= {0, 1, 2} and 1 in state
    assert all((value > 0) == (kind == 1) for value, kind in zip(psi, state))  # psi > 0 where seen.


def test_surface_counts_agree(vantage, straight):
    surface = json.loads((straight / "result.json").read_text())["surface"]
    info = json.loads(vantage("info", straight / "surface.ply", "--json").stdout)
    assert info["kind"] == "surface" and info["points"] == surface["loose_points"]
    assert info["polygons"] + info["segments"] == surface["fits"] + surface["segments"]
    assert info["certified_m"] <= surface["hausdorff"]["certified_m"] * (1 + 1e-6)


def test_info_reads_every_file(vantage, straight):
    kinds = {"scans.log": "scan log", "scenario.toml": "scenario", "scans/000.ply": "point cloud", "surface.ply": "surface", "belief.vti": "lattice", ".": "run"}
    for name, kind in kinds.items():
        result = vantage("info", straight / name, "--json")
        assert json.loads(result.stdout)["kind"] == kind, name
        assert vantage("info", straight / name).stdout


def test_scan_reconstruct_visibility_agree(vantage, straight, scene, tmp_path):
    """The stages one by one on the first station give what the run had after it."""
    place = ",".join(str(value) for value in json.loads((straight / "result.json").read_text())["steps"][0]["vantage"])
    arguments = [a for a in scene if a not in ("--grid", "50", "24")]
    for name in ("scan.ply", "scan.xyz", "scan.log"):
        assert vantage("scan", *arguments, "--at", place, "-o", tmp_path / name, "-q").returncode == 0
    assert (tmp_path / "scan.ply").read_bytes() == (straight / "scans/000.ply").read_bytes()
    log = (tmp_path / "scan.log").read_bytes()
    assert (straight / "scans.log").read_bytes().startswith(log)
    figures = [json.loads(vantage("reconstruct", tmp_path / name, "--json", "-o", tmp_path / "surface.ply").stdout) for name in ("scan.xyz", "scan.log")]
    assert figures[0] == figures[1] and figures[0]["points"] > 0
    result = vantage("visibility", tmp_path / "surface.ply", "--from", place, "--grid", 20, "-o", tmp_path / "seen.vti", "--json")
    assert result.returncode == 0, result.stderr
    assert 0 < json.loads(result.stdout)["seen_fraction"] < 1
    nodes, arrays = vti_arrays(tmp_path / "seen.vti")
    assert list(arrays) == ["phi"] and len(arrays["phi"][1]) == 4 * nodes


def test_config_dump_is_a_scenario(vantage, scene, tmp_path):
    dump = vantage("config", "dump", *scene, "--eta", "0.07", "--set", "planner.metric=boundary").stdout
    assert "eta = 0.07" in dump and 'metric = "boundary"' in dump and "# Hausdorff" in dump
    (tmp_path / "mine.toml").write_text(dump)
    again = vantage("config", "dump", tmp_path / "mine.toml").stdout
    assert again == dump
    assert vantage("config", "dump", tmp_path / "mine.toml", "--eta", "0.08").stdout == dump.replace("eta = 0.07", "eta = 0.08")


def test_later_settings_win(vantage, tmp_path):
    (tmp_path / "base.toml").write_text("[surface]\neta = 0.2\nmin_points = 9\n[explore]\ngrid = 40\n")
    dump = vantage("config", "dump", "planar", "--config", tmp_path / "base.toml", "--eta", "0.3").stdout
    assert "eta = 0.3" in dump and "min_points = 9" in dump and "voxel = 0.5" in dump
    assert "voxel = 0.25" in vantage("config", "dump", "planar", "--config", tmp_path / "base.toml", "--voxel", "0.25").stdout


def test_quiet_json_and_help(vantage, tmp_path):
    result = vantage("explore", "planar", "--max-scans", 1, "-o", tmp_path / "a", "--json", "-q")
    assert result.stderr == "" and json.loads(result.stdout)["scans"] == 1
    result = vantage("explore", "planar", "--max-scans", 1, "-o", tmp_path / "b")
    assert result.stdout.splitlines()[-1] == f"report: {tmp_path}/b/report.html"
    assert "scan   0" in result.stderr and "\033" not in result.stderr
    for command in ("explore", "scan", "paper", "reconstruct", "publish", "merge", "visibility", "scene", "info", "config"):
        text = vantage(command, "--help")
        assert text.returncode == 0 and "Examples:" in text.stdout and f"vantage {command}" in text.stdout
        assert vantage("help", command).stdout == text.stdout
        assert f"  {command} " in vantage("--help").stdout
    assert vantage("--version").stdout.startswith("vantage ")


def test_default_folder_has_the_scene_name(vantage, tmp_path):
    assert vantage("explore", "planar:seed=3", "--max-scans", 1, "-q", cwd=tmp_path).returncode == 0
    assert (tmp_path / "runs/planar/report.html").exists()
    assert vantage("explore", "planar:seed=3", "--max-scans", 2, "-q", "--resume", cwd=tmp_path).returncode == 0


def test_no_plan_is_told_apart(vantage, tmp_path):
    """Unseen space remains and the run gives up: exit code 6, the reason in one line, the outputs saved all the same."""
    result = vantage("explore", "planar", "--set", "planner.idle_limit=1", "-o", tmp_path / "run", "--json", "-q")
    verdict = json.loads(result.stdout)["verdict"]
    assert result.returncode == 6 and verdict["complete"] is False
    assert result.stderr == f"vantage: {verdict['reason']}\n"
    assert (tmp_path / "run/report.html").exists()


@pytest.mark.parametrize("no_color", [False, True])
def test_live_line_on_a_terminal(vantage, tmp_path, no_color):
    program = vantage("--version").args[0]
    screen, terminal = pty.openpty()
    environment = {**os.environ, "TERM": "xterm", "NO_COLOR": "1" if no_color else ""}
    with subprocess.Popen([program, "explore", *SCENES["3d"], "-o", tmp_path / "run"], stdout=subprocess.PIPE, stderr=terminal, text=True, env=environment) as process:
        os.close(terminal)
        shown = b""
        while True:
            try:
                part = os.read(screen, 65536)
            except OSError:  # The other end is closed.
                break
            if not part:
                break
            shown += part
        out = process.stdout.read()
    os.close(screen)
    text = shown.decode()
    assert process.returncode in (0, 6) and out.splitlines()[-1].startswith("report: ")
    assert "% seen" in text and "█" in text and "\n" not in text.replace("vantage: ", "").strip("\r\n")
    assert ("\033[36m" in text) != no_color
    assert text.rstrip().endswith("\033[K")  # The line is gone in the end.
