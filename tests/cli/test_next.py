# SPDX-License-Identifier: Apache-2.0
"""Where to scan next, from a person's scans: poses, folders that grow, lists that differ, and a loop that ends where exploring ends."""

import csv
import json
import math
import struct

import pytest
from next_scenes import COARSE, ask, at, write_slabs

DOMAIN = "0,0,0,10,6,3"


SLABS = [((-1, -1, -1), (11, 7, 0)), ((-1, -1, 3), (11, 7, 4)), ((-1, -1, 0), (0, 7, 3)), ((10, -1, 0), (11, 7, 3)),
         ((0, -1, 0), (10, 0, 3)), ((0, 6, 0), (10, 7, 3)), ((4.9, 0, 0), (5.1, 4.5, 3))]  # fmt: skip


@pytest.fixture(scope="module")
def rooms(tmp_path_factory):
    """Two rooms, 10 x 6 x 3 m together, with a door 1.5 m wide between them."""
    path = tmp_path_factory.mktemp("rooms") / "rooms.obj"
    write_slabs(path, SLABS)
    return path


@pytest.fixture(scope="module")
def scan(vantage, rooms, tmp_path_factory):
    """scan(x, y, z) -> file of a simulated scan."""
    folder = tmp_path_factory.mktemp("scans")

    def take(*place):
        path = folder / ("_".join(f"{x:.4f}" for x in place) + ".ply")
        result = vantage("scan", rooms, "--step-deg", 2, "--at", ",".join(map(str, place)), "-o", path, "-q")
        assert result.returncode == 0, result.stderr
        return path

    return take


def test_the_other_room_is_next(vantage, scan):
    answer = ask(vantage, scan(2, 2, 1.5), "--at", "2,2,1.5", "--domain", DOMAIN, *COARSE)
    assert list(answer)[:6] == ["vantage", "score", "ranked", "unseen_m3", "path", "verdict"]
    best = answer["ranked"][0]
    assert answer["vantage"] == best["vantage"] and answer["score"] == best["score"]
    assert best["new_volume_m3"] > 20 and not answer["verdict"]["complete"]
    assert answer["unseen_m3"] > 40 and 0 < best["overlap"] <= 1
    assert math.dist(answer["path"][0], [2, 2, 1.5]) < 1e-9 and answer["path"][-1] == best["vantage"]
    assert best["vantage"][2] == pytest.approx(1.5, abs=0.26)  # On the floor, as the scan was.
    for k, place in enumerate(answer["ranked"]):
        for other in answer["ranked"][:k]:
            assert math.dist(place["vantage"], other["vantage"]) >= 1.0
        assert place["added_volume_m3"] <= place["new_volume_m3"] + 1e-9


def test_a_loop_of_next_sees_what_exploring_sees(vantage, rooms, scan, tmp_path):
    place, run = (2, 2, 1.5), tmp_path / "run"
    result = vantage("explore", rooms, "--start", at(place), "--step-deg", 2, *COARSE, "-o", tmp_path / "explored", "--json", "-q")
    assert result.returncode in (0, 6), result.stderr
    explored = json.loads(result.stdout)
    goal = 0.97 * max(step["seen_volume_m3"] for step in explored["steps"])
    answer = ask(vantage, scan(*place), "--at", at(place), "--domain", DOMAIN, *COARSE, "--stand", "air", "-o", run)
    for _ in range(8):
        if not answer["vantage"] or answer["seen_m3"] >= goal:
            break
        place = answer["vantage"]
        answer = ask(vantage, run, scan(*place), "--at", at(place))
    assert answer["seen_m3"] >= goal
    assert answer["scans"] <= len(explored["steps"]) + 2
    with open(run / "stations.csv", newline="") as file:
        assert len(list(csv.DictReader(file))) == answer["scans"]
    assert json.loads((run / "next.json").read_text())["vantage"] == answer["vantage"]
    page = (run / "report.html").read_text()
    assert page.rstrip().endswith("</html>") and "Where to scan next" in page and "What was assumed" in page


def test_a_folder_grows_keeps_wishes_and_forgets_scans(vantage, scan, tmp_path):
    run, first, second = tmp_path / "run", scan(2, 2, 1.5), scan(4, 5, 1.5)
    wishes = ("--domain", DOMAIN, *COARSE, "--count", 2, "--range", 20)
    alone = ask(vantage, first, "--at", "2,2,1.5", *wishes, "-o", run)
    assert alone["scans"] == 1 and len(alone["ranked"]) <= 2
    both = ask(vantage, run, second, "--at", "4,5,1.5")
    assert both["scans"] == 2 and both["seen_m3"] > alone["seen_m3"] + 5 and len(both["ranked"]) <= 2
    assert [i["name"] for i in json.loads((run / "manifest.json").read_text())["inputs"]] == [first.name, second.name]
    poses = tmp_path / "poses.txt"
    poses.write_text("2 2 1.5\n4 5 1.5\n")
    once = ask(vantage, first, second, "--poses", poses, *wishes)
    assert once["ranked"] == both["ranked"] and once["seen_m3"] == both["seen_m3"]
    again = ask(vantage, run, "--threads", 1)
    assert again["ranked"] == both["ranked"]
    less = ask(vantage, run, "--remove", 1)
    assert (less["scans"], less["ranked"], less["seen_m3"]) == (1, alone["ranked"], alone["seen_m3"])


def test_poses_move_and_turn_points_of_the_scanners_frame(vantage, scan, tmp_path):
    world = scan(2, 2, 1.5)
    local, poses = tmp_path / "local.xyz", tmp_path / "poses.csv"
    xyz = tmp_path / "world.xyz"
    # The same points by hand: world = turn by 90 degrees, then move.
    raw = world.read_bytes()
    points = list(struct.iter_unpack("<3f", raw[raw.index(b"end_header\n") + 11 :]))
    xyz.write_text("".join(f"{x} {y} {z}\n" for x, y, z in points))
    local.write_text("".join(f"{y - 2} {-(x - 2)} {z - 1.5}\n" for x, y, z in points))
    poses.write_text("name,x,y,z,qw,qx,qy,qz\nlocal,2,2,1.5,0.70710678118654752,0,0,0.70710678118654752\n")
    common = ("--domain", DOMAIN, *COARSE)
    a, b = ask(vantage, xyz, "--at", "2,2,1.5", *common), ask(vantage, local, "--poses", poses, *common)
    assert b["seen_m3"] == pytest.approx(a["seen_m3"], rel=0.02)
    assert math.dist(a["vantage"], b["vantage"]) < 1.5
    feet = tmp_path / "feet.xyz"
    feet.write_text("".join(f"{x / 0.3048} {z / 0.3048} {-y / 0.3048}\n" for x, y, z in points))  # y is up.
    c = ask(vantage, feet, "--unit", "ft", "--up", "y", "--at", "2,2,1.5", *common)
    assert c["seen_m3"] == pytest.approx(a["seen_m3"], rel=0.02)


def test_wishes(vantage, scan):
    base = (scan(2, 2, 1.5), "--at", "2,2,1.5", "--domain", DOMAIN, *COARSE)
    free = ask(vantage, *base, "--count", 1)["ranked"][0]["vantage"]
    low, high = [x - 0.6 for x in free], [x + 0.6 for x in free]
    kept_out = ask(vantage, *base, "--keep-out", at(low + high))
    for place in kept_out["ranked"]:
        assert any(not (a <= x <= b) for x, a, b in zip(place["vantage"], low, high))
    planned = ask(vantage, *base, "--planned", at(free))
    for place in planned["ranked"]:
        assert math.dist(place["vantage"], free) >= 1.0 and place["added_volume_m3"] < place["new_volume_m3"]
    for place in ask(vantage, *base, "--overlap", 0.5)["ranked"]:
        assert place["overlap"] >= 0.5
    for place in ask(vantage, *base, "--height", 0.8)["ranked"]:
        assert place["vantage"][2] == pytest.approx(0.8, abs=0.26)
    assert ask(vantage, *base, "--no-return", "unknown")["seen_m3"] <= ask(vantage, *base)["seen_m3"] + 1e-9


def test_a_run_of_explore_can_be_asked(vantage, rooms, tmp_path):
    run = tmp_path / "run"
    result = vantage("explore", rooms, "--start", "2,2,1.5", "--step-deg", 2, *COARSE, "--max-scans", 1, "-o", run, "-q")
    assert result.returncode in (0, 6), result.stderr
    before = (run / "result.json").read_bytes()
    answer = ask(vantage, run)
    assert answer["scans"] == 1 and answer["vantage"] and (run / "next.csv").exists()
    assert (run / "result.json").read_bytes() == before
    vantage("explore", "--resume", "-o", run, "--max-scans", 2, "-q")
    second = json.loads((run / "result.json").read_text())["steps"][1]["vantage"]
    assert answer["vantage"] == second


def test_the_tour_passes_every_place(vantage, scan):
    answer = ask(vantage, scan(2, 2, 1.5), "--at", "2,2,1.5", "--domain", DOMAIN, *COARSE, "--count", 4)
    tour = answer["tour"]
    assert sorted(tour["order"]) == list(range(1, len(answer["ranked"]) + 1)) and len(tour["order"]) > 1
    assert math.dist(tour["path"][0], [2, 2, 1.5]) < 1e-9
    for place in answer["ranked"]:
        assert min(math.dist(place["vantage"], p) for p in tour["path"]) < 1e-9
    assert tour["path_m"] == pytest.approx(sum(math.dist(a, b) for a, b in zip(tour["path"], tour["path"][1:])))
    assert tour["path_m"] <= sum(2 * place["path_m"] for place in answer["ranked"])


def test_a_scan_of_another_place_is_reported(vantage, scan, tmp_path):
    poses = tmp_path / "poses.txt"
    poses.write_text("2 2 1.5\n14 2 1.5\n")
    moved = tmp_path / "far.xyz"
    moved.write_text("".join(f"{13 + math.cos(k / 30)} {2 + math.sin(k / 30)} {1 + k % 10 / 10}\n" for k in range(2000)))
    result = vantage("next", scan(2, 2, 1.5), moved, "--poses", poses, "--voxel", 0.25, "--json")
    assert result.returncode in (0, 6) and "another place" in result.stderr


def test_a_scan_given_twice_is_refused(vantage, scan, tmp_path):
    run, file = tmp_path / "run", scan(2, 2, 1.5)
    common = ("--domain", DOMAIN, *COARSE)
    alone = ask(vantage, file, "--at", "2,2,1.5", *common, "-o", run)
    before = {p.name: p.read_bytes() for p in run.iterdir() if p.is_file()}
    for arguments, says in (((run, file, "--at", "3,2,1.5"), "are those of scan 0"), ((file, file, "--at", "2,2,1.5", "--at", "2,2,1.5"), "a scan counts once")):
        result = vantage("next", *arguments)
        assert result.returncode == 2 and result.stdout == "" and says in result.stderr and len(result.stderr.splitlines()) == 1
    assert {p.name: p.read_bytes() for p in run.iterdir() if p.is_file()} == before
    result = vantage("next", run, file, "--at", "2,2,1.5")  # As after a command that was stopped.
    assert result.returncode == 0 and "not added again" in result.stderr
    assert (run / "scans.log").read_bytes() == before["scans.log"]
    both = ask(vantage, run, file, "--at", "2,2,1.5", "--force")
    assert both["scans"] == 2 and both["seen_m3"] == pytest.approx(alone["seen_m3"], rel=0.01)
    assert ask(vantage, run / "scans.log")["ranked"] == ask(vantage, run)["ranked"]  # The log stands for its folder.


def test_what_another_scan_looks_through_has_moved(vantage, scan, tmp_path):
    """A person in the first scan only, which a second scan shows: the log keeps all points, so asking again finds who has gone meanwhile."""
    peopled, run = tmp_path / "peopled.obj", tmp_path / "run"
    write_slabs(peopled, [*SLABS, ((2.8, 4.0, 0.001), (3.2, 4.4, 1.7))])
    first = tmp_path / "first.ply"
    assert vantage("scan", peopled, "--step-deg", 2, "--at", "2,2,1.5", "-o", first, "-q").returncode == 0
    alone = ask(vantage, first, "--at", "2,2,1.5", "--domain", DOMAIN, *COARSE, "--moved", "drop", "-o", run)
    assert alone["moved"] == [0]
    both = ask(vantage, run, scan(4, 5, 1.5), "--at", "4,5,1.5")
    assert both["moved"][0] > 20 and both["moved"][1] == 0
    note = next(note for note in both["notes"] if "moved" in note)
    assert f" {both['moved'][0]} " in note
    kept = ask(vantage, run, "--moved", "keep")
    assert "moved" not in kept and not any("moved" in note for note in kept["notes"])



def test_the_filter_is_reported(vantage, scan, tmp_path):
    rows = scan(2, 2, 1.5).read_bytes()
    points = list(struct.iter_unpack("<3f", rows[rows.index(b"end_header\n") + 11 :]))
    dusty = tmp_path / "dusty.xyz"
    dust = [(2 + 0.7 * math.cos(k), 2 + 0.7 * math.sin(k), 1.2 + 0.06 * k) for k in range(10)]
    dusty.write_text("".join(f"{x} {y} {z}\n" for x, y, z in points + dust))
    common = (dusty, "--at", "2,2,1.5", "--domain", DOMAIN, *COARSE)
    answers = [vantage("next", *common, "--json"), vantage("next", *common, "--filter", "isolated", "--json", "-o", tmp_path / "run")]
    assert all(answer.returncode in (0, 6) for answer in answers), answers  # The dust may hem the scanner in.
    plain, filtered = (json.loads(answer.stdout) for answer in answers)
    assert not any("filter" in note for note in plain["notes"])
    note = next(note for note in filtered["notes"] if "filter" in note)
    assert "isolated points" in note and "mixed" not in note
    left_out = json.loads((tmp_path / "run/manifest.json").read_text())["inputs"][0]["left_out"]
    assert left_out["isolated"] >= 10 and left_out["mixed"] == 0


@pytest.mark.parametrize("arguments, says", [
    ((), "SCANS is missing"),
    (("SCAN", "--at", "2,2,1.5", "--filter", "veil"), "measured.filter"),
    (("SCAN", "--at", "2,2,1.5", "--moved", "gone"), "next.moved"),
    (("SCAN", "--at", "2,2,1.5", "--set", "measured.filter_angle_deg=90"), "0.1 .. 45"),
    (("SCAN",), "--at x,y,z"),
    (("SCAN", "--at", "1,2"), "x,y,z"),
    (("SCAN", "--at", "2,2,1.5", "--at", "1,1,1"), "2 places for 1 scans"),
    (("SCAN", "--at", "2,2,1.5", "--poses", "POSES"), "one of them"),
    (("SCAN", "--poses", "POSES"), "2 poses for 1 scans"),
    (("SCAN", "--poses", "nowhere.csv"), "nowhere.csv"),
    (("nowhere.ply", "--at", "0,0,0"), "nowhere.ply"),
    (("SCAN", "--at", "600000,5000000,100"), "in the same coordinates?"),
    (("SCAN", "--at", "2,2,1.5", "--up", "w"), "measured.up"),
    (("SCAN", "--at", "2,2,1.5", "--unit", "yards"), "measured.unit"),
    (("SCAN", "--at", "2,2,1.5", "--height", "-1"), "next.height"),
    (("SCAN", "--at", "2,2,1.5", "--domain", "0,0,0,1"), "--domain"),
    (("SCAN", "--at", "2,2,1.5", "--domain", "4,4,0,9,9,3"), "--domain"),
    (("SCAN", "--at", "2,2,1.5", "--keep-out", "1,1,1,0,0,0"), "--keep-out"),
    (("SCAN", "--at", "2,2,1.5", "--min-range", "90"), "90"),
    (("SCAN", "--at", "2,2,1.5", "--remove", "0"), "--remove"),
    (("SCAN", "--at", "2,2,1.5", "--set", "next.cuont=3"), "next.count"),
    (("SCAN", "--at", "2,2,1.5", "--overlaps", "0.2"), "--overlap"),
    ((".",), "a folder, and not a run"),
])  # fmt: skip
def test_wrong_input_is_one_line(vantage, scan, tmp_path, arguments, says):
    (tmp_path / "POSES").write_text("0 0 0\n1 1 1\n")
    names = {"SCAN": scan(2, 2, 1.5), "POSES": tmp_path / "POSES"}
    result = vantage("next", *(names.get(a, a) for a in arguments), cwd=tmp_path)
    assert (result.returncode in (2, 3), result.stdout) == (True, "")
    assert says in result.stderr and len(result.stderr.splitlines()) == 1
    assert [p.name for p in tmp_path.iterdir()] == ["POSES"]


def test_corridor(vantage, data, tmp_path):
    scans = [data(f"corridor_tls/scan00{k}.pcd") for k in range(6)]
    answer = ask(vantage, *scans, "--poses", data("corridor_tls/poses.csv"))
    assert answer["scans"] == 6 and answer["ranked"] and answer["ranked"][0]["new_volume_m3"] > 10
    assert answer["vantage"][2] == pytest.approx(0.0, abs=0.7)  # As high as the tripod stood.


def test_a_scan_that_is_there_is_not_added_twice(vantage, scan, tmp_path):
    """A command that was stopped can be given again; by force, another place makes another scan."""
    a, b = scan(2, 3, 1.5), scan(8, 3, 1.5)
    run = tmp_path / "run"
    assert vantage("next", a, "--at", "2,3,1.5", "--domain", DOMAIN, *COARSE, "-o", run, "-q").returncode == 0
    assert vantage("next", run, b, "--at", "8,3,1.5", "-q").returncode == 0
    before = {path.name: path.read_bytes() for path in run.rglob("*") if path.is_file()}
    result = vantage("next", run, b, "--at", "8,3,1.5")
    assert result.returncode == 0 and f"{b.name}: is scan 1 of the run already, and not added again" in result.stderr
    assert {path.name: path.read_bytes() for path in run.rglob("*") if path.is_file()} == before
    assert ask(vantage, run, a, "--at", "2,3,1.6", "--force")["scans"] == 3
    assert ask(vantage, run, b, "--at", "8,3,1.5", "--remove", 1)["scans"] == 3
    names = [entry["name"] for entry in json.loads((run / "manifest.json").read_text())["inputs"]]
    assert names == [a.name, a.name, b.name]
    for text in ("", "[]", '{"inputs": ' + 100000 * "["):  # Costs the names, no scan.
        (run / "manifest.json").write_text(text)
        assert ask(vantage, run, b, "--at", "8,3,1.5", "--force")["scans"] == 4
        assert ask(vantage, run, "--remove", 3)["scans"] == 3
