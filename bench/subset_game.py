# SPDX-License-Identifier: Apache-2.0
"""The subset game: of scans that were taken, hide all but the first and let `vantage next` choose among their places, one after the other, until it
sees a share of the volume that all of them see; beside it the greedy oracle, which knows what every scan shows.

    python3 bench/subset_game.py --program build/release/bin/vantage --poses DIR/poses.csv DIR/scan00?.pcd
"""

import argparse
import csv
import json
import subprocess
from pathlib import Path


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scans", nargs="+", help="files; the poses' first column has their names without the ending")
    parser.add_argument("--poses", required=True, help="CSV with a header: name, tx, ty, tz …")
    parser.add_argument("--program", default="build/release/bin/vantage")
    parser.add_argument("--share", type=float, default=0.95)
    parser.add_argument("--voxel", default="0.3")
    parser.add_argument("--range", default="59")
    parser.add_argument("--more", default="", help="more options of vantage next, between blanks")
    return parser.parse_args()


class Game:
    def __init__(self, given):
        self.given, self.cache = given, {}
        with open(given.poses, newline="") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        name, place = next(iter(rows[0])), ("tx", "ty", "tz") if "tx" in rows[0] else ("x", "y", "z")
        self.places = {row[name]: ",".join(row[a] for a in place) for row in rows}
        self.domain = []

    def ask(self, chosen, among=()):
        """What `next` answers after the scans `chosen`, of the places of the scans `among`."""
        key = (tuple(chosen), tuple(among))
        if key not in self.cache:
            command = [self.given.program, "next", *chosen, "--poses", self.given.poses, "--voxel", self.given.voxel, "--range", self.given.range,
                       "--json", "-q", *self.domain, *self.given.more.split()]  # fmt: skip
            for scan in among:
                command += ["--among", self.places[Path(scan).stem]]
            result = subprocess.run(command, capture_output=True, text=True)
            if result.returncode not in (0, 6):
                raise SystemExit(result.stderr)
            self.cache[key] = json.loads(result.stdout)
        return self.cache[key]

    def seen(self, chosen):
        return self.ask(sorted(chosen))["seen_m3"]

    def oracle(self, goal):
        chosen = [self.given.scans[0]]
        while self.seen(chosen) < goal:
            rest = [s for s in self.given.scans if s not in chosen]
            chosen.append(max(rest, key=lambda s: self.seen([*chosen, s])))
        return chosen

    def planner(self, goal):
        chosen = [self.given.scans[0]]
        while self.seen(chosen) < goal:
            rest = [s for s in self.given.scans if s not in chosen]
            best = self.ask(chosen, rest)["vantage"]
            near = lambda s: sum((a - float(b)) ** 2 for a, b in zip(best, self.places[Path(s).stem].split(",")))  # noqa: E731
            chosen.append(min(rest, key=near) if best else rest[0])
        return chosen


def main():
    given = options()
    game = Game(given)
    # One box for all: that of all scans.
    run = subprocess.run([given.program, "next", *given.scans, "--poses", given.poses, "--voxel", given.voxel, "--range", given.range, "--json", "-q",
                          *given.more.split()], capture_output=True, text=True)  # fmt: skip
    everything = json.loads(run.stdout)
    low, high = everything["domain"]
    game.domain = ["--domain", ",".join(map(str, low + high))]
    total = game.seen(given.scans)
    goal = given.share * total
    print(f"all {len(given.scans)} scans see {total:.1f} m3; goal {goal:.1f} m3 ({100 * given.share:.0f} %)")
    for name, play in (("oracle", game.oracle), ("planner", game.planner)):
        chosen = play(goal)
        shares = " ".join(f"{100 * game.seen(chosen[: k + 1]) / total:.1f}" for k in range(len(chosen)))
        print(f"{name}: {len(chosen)} scans: {' '.join(Path(s).stem for s in chosen)}; share after each: {shares} %")
    orders = sorted(given.scans[1:])
    worst = [given.scans[0]]
    while game.seen(worst) < goal:
        worst.append(min((s for s in orders if s not in worst), key=lambda s: game.seen([*worst, s])))
    print(f"the least useful scan each time: {len(worst)} scans")


if __name__ == "__main__":
    main()
