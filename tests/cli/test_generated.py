# SPDX-License-Identifier: Apache-2.0
"""Small random scenes from the command line: counts, one played again, going on where it stopped, wrong names."""

import json


def test_counts_and_goes_on(vantage, tmp_path):
    folder = tmp_path / "long"
    command = ["audit", "--kinds", "box,maze-2d", "--seed", 7, "-o", folder, "--json"]
    first = vantage(*command, "--generated", 3)
    assert first.returncode == 0, first.stderr
    kept = (folder / "generated.json").read_bytes()
    second = vantage(*command, "--generated", 6)
    assert second.returncode == 0, second.stderr
    table = json.loads(second.stdout)
    assert table["all"]["runs"] == table["all"]["ended"] == 6
    assert {name: sums["runs"] for name, sums in table["kinds"].items()} == {"box-2d": 2, "box-3d": 2, "maze-2d": 2}
    for count in ("repeated", "collisions", "unsafe", "untrue_reasons", "errors"):
        assert table["all"][count] == 0
    runs = json.loads((folder / "generated.json").read_text())["runs"]
    assert runs[:3] == json.loads(kept)["runs"]
    again = vantage("audit", "--generated", 1, "--kinds", runs[3]["kind"], "--seed", runs[3]["seed"], "-v")
    assert again.returncode == 0 and f"seed {runs[3]['seed']}" in again.stdout


def test_wrong_input(vantage):
    for arguments, word in (
        (["--generated", 3, "--kinds", "castle"], "castle"),
        (["--generated", 0], "0"),
        (["--generated", 3, "planar"], "SCENE"),
        (["planar", "--kinds", "box"], "--kinds"),
    ):
        result = vantage("audit", *arguments)
        assert result.returncode == 2 and word in result.stderr and len(result.stderr.splitlines()) == 1
