# SPDX-License-Identifier: Apache-2.0
"""What the tests of vantage next share."""

import json

COARSE = ("--voxel", 0.25, "--eta", 0.05)


def write_slabs(path, slabs):
    """Boxes, given by their low and high corners, as an OBJ file."""
    lines = []
    for number, (low, high) in enumerate(slabs):
        corners = [[(low, high)[k >> a & 1][a] for a in range(3)] for k in range(8)]
        quads = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
        lines += ["v {} {} {}".format(*corner) for corner in corners]
        for a, b, c, d in quads:
            lines += ["f " + " ".join(str(i + 1 + 8 * number) for i in triangle) for triangle in ((a, b, c), (a, c, d))]
    path.write_text("\n".join(lines) + "\n")


def ask(vantage, *arguments, codes=(0,), **options):
    result = vantage("next", *arguments, "--json", **options)
    assert result.returncode in codes, result.stderr
    return json.loads(result.stdout)


def at(place):
    return ",".join(map(str, place))
