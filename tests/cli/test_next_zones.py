# SPDX-License-Identifier: Apache-2.0
"""Zones of vantage next: polygons and boxes, inline and from files, where no scanner may go and where what is hidden counts more."""

import json
import math
import struct

import pytest
from next_scenes import COARSE, ask, at, write_slabs

DOMAIN = "0,0,0,18,6,3"
HERE = (8, 3, 1.5)
LEFT = "0,0 6,0 6,6 0,6"
PROJECTED = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}


@pytest.fixture(scope="module")
def rooms(tmp_path_factory):
    """A small room, a middle one and a large one in a row, 18 x 6 x 3 m together, joined by doors at y < 1.5."""
    path = tmp_path_factory.mktemp("three") / "rooms.obj"
    slabs = [((-1, -1, -1), (19, 7, 0)), ((-1, -1, 3), (19, 7, 4)), ((-1, -1, 0), (0, 7, 3)), ((18, -1, 0), (19, 7, 3)),
             ((0, -1, 0), (18, 0, 3)), ((0, 6, 0), (18, 7, 3)), ((5.9, 1.5, 0), (6.1, 6, 3)), ((9.9, 1.5, 0), (10.1, 6, 3))]  # fmt: skip
    write_slabs(path, slabs)
    return path


@pytest.fixture(scope="module")
def base(vantage, rooms, tmp_path_factory):
    """Arguments of a question about one scan in the middle."""
    path = tmp_path_factory.mktemp("scans") / "middle.ply"
    result = vantage("scan", rooms, "--step-deg", 2, "--at", at(HERE), "-o", path, "-q")
    assert result.returncode == 0, result.stderr
    return path, "--at", at(HERE), "--domain", DOMAIN, *COARSE


def corners_of(text):
    return [tuple(map(float, corner.split(","))) for corner in text.split()]


def distance(p, a, b):
    """Of p to the segment from a to b."""
    d = (b[0] - a[0], b[1] - a[1])
    t = max(0.0, min(1.0, ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / max(d[0] ** 2 + d[1] ** 2, 1e-12)))
    return math.hypot(p[0] - a[0] - t * d[0], p[1] - a[1] - t * d[1])


def inside(polygon, p):
    odd = False
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        if (a[1] > p[1]) != (b[1] > p[1]) and p[0] < a[0] + (p[1] - a[1]) * (b[0] - a[0]) / (b[1] - a[1]):
            odd = not odd
    return odd


def places_on(path):
    """Every 5 cm along a path."""
    for a, b in zip(path, path[1:]):
        n = max(1, int(math.dist(a, b) / 0.05))
        yield from ([x + (y - x) * k / n for x, y in zip(a, b)] for k in range(n + 1))


def test_must_see_changes_the_choice(vantage, base, tmp_path):
    free = ask(vantage, *base)
    assert free["vantage"][0] > 9, "the large room is worth more"
    for zone in (LEFT, "0,0,0,6,6,3", f"{LEFT} z=0..3"):
        wished = ask(vantage, *base, "--must-see", zone)
        assert wished["vantage"][0] < 7, zone
        for place in wished["ranked"]:  # What counts more does not weigh more.
            assert place["added_volume_m3"] <= place["new_volume_m3"] + 1e-9 < 18 * 6 * 3


def test_no_station_and_no_way_in_a_kept_out_polygon(vantage, base):
    free = ask(vantage, *base)
    x, y, _ = free["vantage"]
    triangle = f"{x - 1.1},{y - 1} {x + 1.3},{y - 1.2} {x + 0.1},{y + 1.4}"
    assert inside(corners_of(triangle), free["vantage"])
    fence = "7,0.5 7.05,0.5 7.05,5.9 7,5.9"  # Far thinner than a cell.
    answer = ask(vantage, *base, "--keep-out", triangle, "--keep-out", fence)
    assert answer["ranked"]
    for zone in map(corners_of, (triangle, fence)):
        for path in (answer["path"], answer["tour"]["path"]):
            assert not any(inside(zone, p) for p in places_on(path))
        for place in answer["ranked"]:
            p = place["vantage"]
            assert not inside(zone, p) and min(distance(p, a, b) for a, b in zip(zone, zone[1:] + zone[:1])) > 0.05
    high = ask(vantage, *base, "--keep-out", f"{triangle} z=2.5..3")
    assert high["ranked"] == free["ranked"], "nobody stands that high"


def test_files_of_polygons(vantage, base, tmp_path):
    inline = ask(vantage, *base, "--must-see", LEFT, "--keep-out", "11,1 17,1 17,5", "--keep-out", "1,4,0,2,5,3")
    ring = [[x, y] for x, y in corners_of(LEFT)]
    files = {
        "left.geojson": {"type": "FeatureCollection", "crs": PROJECTED, "features": [
            {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [ring + ring[:1]]}}]},
        "left.json": {"type": "MultiPolygon", "crs": None, "coordinates": [[[[*p, 7.0] for p in ring + ring[:1]]]]},
    }  # fmt: skip
    for name, content in files.items():
        (tmp_path / name).write_text(json.dumps(content))
    (tmp_path / "left.csv").write_text("0,0\n6,0\n6,6\n0,6\n")
    (tmp_path / "named.csv").write_text("# two zones are one file\nid;North;East\n" + "".join(f"a;{y};{x}\n" for x, y in ring))
    (tmp_path / "out.csv").write_text("11,1\n17,1\n17,5\n\n1,4\n2,4\n2,5\n1,5\n")
    for name in (*files, "left.csv", "named.csv"):
        answer = ask(vantage, *base, "--must-see", name, "--keep-out", "out.csv z=0..3", cwd=tmp_path)
        assert answer["ranked"] == inline["ranked"], name


def test_polygons_count_in_the_coordinates_of_the_scans(vantage, base, tmp_path):
    raw = base[0].read_bytes()
    points = list(struct.iter_unpack("<3f", raw[raw.index(b"end_header\n") + 11 :]))
    (tmp_path / "feet.xyz").write_text("".join(f"{x / 0.3048} {z / 0.3048} {-y / 0.3048}\n" for x, y, z in points))  # y is up.
    common = ("feet.xyz", "--unit", "ft", "--up", "y", *base[1:])
    zone = " ".join(f"{x / 0.3048},{-y / 0.3048}" for x, y in corners_of(LEFT))
    run = tmp_path / "run"
    wished = ask(vantage, *common, "--must-see", f"{zone} z=0..9.9", "-o", run, cwd=tmp_path)
    assert wished["vantage"][0] < 7
    assert ask(vantage, run)["ranked"] == wished["ranked"], "the folder keeps the zone, in metres"
    assert ask(vantage, *common, cwd=tmp_path)["vantage"][0] > 9


@pytest.mark.parametrize("zone, says", [
    ("1,1 2,2", "2 corners"),
    ("0,0 4,4 4,0 0,4", "crosses or touches itself"),
    ("0,0 4,0 4,nan", "nan: must be"),
    ("0,0 4,0 4,1e400", "finite"),
    ("0,0 4,0 4,1,2", "must be x,y"),
    ("0,0 4,0 4,4 z=2..1", "the lower height comes first"),
    ("0,0 4,0 4,4 z=2", "z=LOW..HIGH"),
    ("100,100 104,100 104,104", "outside of the domain"),
    ("100,100,0,104,104,3", "outside of the domain"),
    ("1,2,3", "6 each"),
    ("zone.shp", "must be a box"),
    ("nowhere.geojson", "nowhere.geojson"),
    ("broken.geojson", "broken.geojson:9: not JSON"),
    ("degrees.geojson", "degrees"),
    ("wgs84.geojson", "wgs84.geojson:/crs/properties/name: EPSG:4326: must be a projected system"),
    ("crs84.geojson", "CRS84"),
    ("line.geojson", "no Polygon"),
    ("bow.geojson", "bow.geojson:/coordinates: the polygon crosses"),
    ("corner.geojson", "corner.geojson:/coordinates/0/1: must be [x, y]"),
    ("short.csv", "short.csv:1: 2 corners"),
    ("text.csv", "text.csv:2: b: must be a finite number"),
    ("wide.csv", "wide.csv:2: 3 columns"),
    ("empty.csv", "no corners"),
])  # fmt: skip
@pytest.mark.parametrize("flag", ["--keep-out", "--must-see"])
def test_wrong_zones_are_one_line(vantage, base, tmp_path, flag, zone, says):
    square = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]
    polygon = {"type": "Polygon", "coordinates": [square]}
    files = {
        "broken.geojson": '{"type": ',
        "degrees.geojson": json.dumps(polygon),
        "wgs84.geojson": json.dumps({**polygon, "crs": {"type": "name", "properties": {"name": "EPSG:4326"}}}),
        "crs84.geojson": json.dumps({**polygon, "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:OGC:1.3:CRS84"}}}),
        "line.geojson": json.dumps({"type": "LineString", "coordinates": square, "crs": None}),
        "bow.geojson": json.dumps({"type": "Polygon", "crs": None, "coordinates": [[[0, 0], [4, 4], [4, 0], [0, 4], [0, 0]]]}),
        "corner.geojson": json.dumps({"type": "Polygon", "crs": None, "coordinates": [[[0, 0], [4], [4, 0]]]}),
        "short.csv": "0,0\n4,0\n",
        "text.csv": "0,0\n4,b\n",
        "wide.csv": "0,0\n4,0,0\n",
        "empty.csv": "x,y\n",
    }
    if zone in files:
        (tmp_path / zone).write_text(files[zone])
    before = sorted(p.name for p in tmp_path.iterdir())
    result = vantage("next", *base, flag, zone, "-o", "run", cwd=tmp_path)
    assert (result.returncode in (2, 3), result.stdout) == (True, "")
    assert says in result.stderr and len(result.stderr.splitlines()) == 1
    assert sorted(p.name for p in tmp_path.iterdir()) == before


def test_places_to_choose_among_keep_out(vantage, base):
    zone = ("--keep-out", "10,0 18,0 18,6 10,6")
    answer = ask(vantage, *base, *zone, "--among", "9,1,1.5", "--among", "12,1,1.5")
    assert [place["vantage"] for place in answer["ranked"]] == [[9, 1, 1.5]]
    assert any("--among" in note for note in answer["notes"])
    result = vantage("next", *base, *zone, "--among", "12,1,1.5")
    assert result.returncode == 2 and "--keep-out forbids" in result.stderr
