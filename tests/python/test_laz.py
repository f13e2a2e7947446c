# SPDX-License-Identifier: Apache-2.0
"""LAZ and LAS, one to the other."""

import subprocess
import sys
from pathlib import Path

import laspy
import numpy
import pytest

from vantage import convert


@pytest.fixture
def las(tmp_path):
    """A file with colours, times and a record of its own."""
    header = laspy.LasHeader(version="1.4", point_format=7)
    header.scales, header.offsets = [0.001] * 3, [512000, 5412000, 0]
    header.vlrs.append(laspy.VLR("LASF_Projection", 2112, "WKT", b'PROJCS["x"]'))
    data = laspy.LasData(header)
    random = numpy.random.default_rng(1)
    data.xyz = random.uniform(0, 100, (5000, 3)) + [512345, 5412345, 100]
    data.intensity = random.integers(0, 65536, 5000)
    data.red = random.integers(0, 65536, 5000)
    data.gps_time = random.uniform(0, 1e9, 5000)
    data.write(tmp_path / "a.las")
    return tmp_path / "a.las"


def records(path):
    data = laspy.read(path)
    return data.points.array, [(vlr.user_id, vlr.record_id, vlr.record_data_bytes()) for vlr in data.header.vlrs if vlr.user_id != "laszip encoded"]


def test_there_and_back_every_record_is_the_same(las, tmp_path):
    assert convert.convert(las, tmp_path / "b.laz") == 5000
    assert convert.convert(tmp_path / "b.laz", tmp_path / "c.las") == 5000
    assert (tmp_path / "b.laz").stat().st_size < las.stat().st_size
    points, vlrs = records(las)
    for path in (tmp_path / "b.laz", tmp_path / "c.las"):
        again, vlrs_again = records(path)
        assert numpy.array_equal(again, points) and vlrs_again == vlrs
    assert laspy.open(tmp_path / "c.las").header.point_format.id == 7


def test_points_in_pieces_are_the_same(las, tmp_path, monkeypatch):
    convert.convert(las, tmp_path / "whole.laz")
    monkeypatch.setattr(convert, "PIECE", 777)
    convert.convert(las, tmp_path / "pieces.laz")
    assert numpy.array_equal(records(tmp_path / "whole.laz")[0], records(tmp_path / "pieces.laz")[0])


def test_the_program_reads_what_it_asked_for(las, tmp_path, vantage):
    convert.convert(las, tmp_path / "b.laz")
    refused = vantage("convert", tmp_path / "b.laz", tmp_path / "out.ply")
    assert refused.returncode == 2 and refused.stderr.count("\n") == 1
    assert "`vantage-convert IN.laz OUT.las`" in refused.stderr
    assert not (tmp_path / "out.ply").exists()
    done = subprocess.run([Path(sys.executable).parent / "vantage-convert", tmp_path / "b.laz", tmp_path / "c.las"], capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout == f"{tmp_path / 'c.las'}: 5,000 points\n", done.stderr
    assert vantage("convert", tmp_path / "c.las", tmp_path / "out.ply").returncode == 0


def test_real_laz(data, tmp_path, vantage):
    source = data("las_sample/autzen_trim.laz")
    assert convert.convert(source, tmp_path / "a.las") == 110000
    assert "110,000" in vantage("info", tmp_path / "a.las").stdout



@pytest.mark.parametrize(
    "arguments, code, message",
    [
        (["a.las", "b.ply"], 2, "b.ply: must end in .las or .laz"),
        (["a.xyz", "b.las"], 2, "a.xyz: must end in .las or .laz"),
        (["a.las", "a.las"], 2, "a.las: is there already; --force replaces it"),
        (["none.laz", "b.las"], 3, "none.laz: No such file"),
        (["a.las", "none/b.laz"], 3, "none/b.laz: No such file"),
        (["text.laz", "b.las"], 2, "text.laz: "),
        (["short.las", "b.laz"], 2, "short.las: "),
        (["short.laz", "b.las"], 2, "short.laz: "),
        (["header.laz", "b.las"], 2, "header.laz: "),
        (["empty.laz", "b.las"], 2, "empty.laz: "),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else None,
)
def test_refused_in_one_line_without_output(las, tmp_path, arguments, code, message, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    convert.convert("a.las", "a.laz")
    for name, content in {
        "text.laz": b"hello world\n" * 100,
        "short.las": las.read_bytes()[:90000],
        "short.laz": Path("a.laz").read_bytes()[:60000],
        "header.laz": Path("a.laz").read_bytes()[:200],
        "empty.laz": b"",
    }.items():
        Path(name).write_bytes(content)
    before = sorted(path.name for path in tmp_path.iterdir())
    assert convert.main(arguments) == code
    out, error = capsys.readouterr()
    assert out == "" and error.count("\n") == 1 and error.startswith("vantage-convert: ") and message in error, error
    assert sorted(path.name for path in tmp_path.iterdir()) == before


def test_force_replaces(las, tmp_path):
    target = tmp_path / "b.laz"
    target.write_bytes(b"old")
    with pytest.raises(convert.BadInput):
        convert.convert(las, target)
    assert target.read_bytes() == b"old"
    assert convert.main([str(las), str(target), "--force", "-q"]) == 0
    assert len(laspy.read(target).points) == 5000
