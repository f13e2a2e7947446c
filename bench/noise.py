# SPDX-License-Identifier: Apache-2.0
"""What the scanner's imperfections cost: whole explorations with noise in pose and range, outliers (as they are and filtered) and drop-out, beside
the clean one. Prints a table, draws the curves (OUT/noise.svg) and says whether the goals hold: with noise of half a voxel, 5 % outliers, filtered, and 30 %
drop-out at least 99 % of the clean run's coverage, and at most 0.1 % of the volume falsely free.

    python3 bench/noise.py --program build/release/bin/vantage -o build/noise
"""

import argparse
import json
import subprocess
from pathlib import Path

COVERAGE, FREE = 0.99, 0.001  # The goals.
COLOURS = {"planar": "#1f6feb", "patio": "#d1242f"}


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=["planar", "patio"])
    parser.add_argument("--program", default="build/release/bin/vantage")
    parser.add_argument("--seeds", type=int, default=2, help="runs of each level, with other noise")
    parser.add_argument("--set", action="append", default=[], metavar="STAGE.OPTION=VALUE", help="an option of every run")
    parser.add_argument("-o", "--output", default="build/noise")
    return parser.parse_args()


def voxel_of(given, scene):
    """The lattice spacing of the scene's runs [m]."""
    text = subprocess.run([given.program, "config", "dump", scene], capture_output=True, text=True, check=True).stdout
    own = [option.split("=")[1] for option in given.set if option.startswith("explore.voxel=")]
    return float(own[0] if own else next(line.split("=")[1] for line in text.splitlines() if line.startswith("voxel =")))


def curves(voxel):
    """Of each kind of noise: unit, factor of the figures shown, and settings level by level."""
    half = voxel / 2
    worst = "sensor.outliers=0.05,sensor.dropout=0.3,sensor.confirmed=true"
    return {
        "place": ("cm", 100, {s: f"sensor.pose_noise={s}" for s in (0.02, 0.05, 0.1, 0.2)}),
        "turn": ("degrees", 1, {s: f"sensor.pose_noise_deg={s}" for s in (0.1, 0.25, 0.5, 1.0)}),
        "range": ("cm", 100, {s: f"sensor.range_noise={s:g}" for s in (half / 4, half / 2, half, voxel)}),
        "outliers": ("%", 100, {s: f"sensor.outliers={s}" for s in (0.01, 0.05, 0.1, 0.2)}),
        "outliers, filtered": ("%", 100, {s: f"sensor.outliers={s},sensor.confirmed=true" for s in (0.01, 0.05, 0.1, 0.2)}),
        "drop-out": ("%", 100, {s: f"sensor.dropout={s}" for s in (0.1, 0.3, 0.5)}),
        "goal, range": ("cm", 100, {half: f"sensor.range_noise={half:g},{worst}"}),
        "goal, place": ("cm", 100, {half: f"sensor.pose_noise={half:g},{worst}"}),
    }


def play(given, scene, levels):
    """Every level's runs: name -> (share seen, share falsely free, scans, ended), each a mean of the seeds."""
    command = [given.program, "audit", scene, "--scene-start", "--starts", "1", "--to-the-end", "--cap", "20", "--variants", "none", "-q", "--json"]
    command += ["-o", str(Path(given.output) / scene)] + [word for option in given.set for word in ("--set", option)]
    for name, settings in levels.items():
        for seed in range(1, given.seeds + 1):
            command += ["--variant", f"{name}-{seed}={settings + ',' if settings else ''}sensor.seed={seed}"]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        raise SystemExit(result.stderr)
    runs = {}
    for run in json.loads(result.stdout)["scenes"][0]["runs"]:
        figures = run["coverage"][-1], run["false_free_m3"] / run["reference_m3"], run["scans"], float(run["verdict"]["finished"])
        runs.setdefault(run["variant"].rsplit("-", 1)[0], []).append(figures)
    return {name: [sum(column) / len(column) for column in zip(*all_runs)] for name, all_runs in runs.items()}


def rows_of(given, scene):
    kinds = curves(voxel_of(given, scene))
    levels = {"clean": ""}
    levels.update({f"{kind}-{i}".replace(", ", "-"): s for kind, (_, _, all_) in kinds.items() for i, s in enumerate(all_.values())})
    played = play(given, scene, levels)
    clean = played["clean"]
    rows = [{"kind": "clean", "level": 0.0, "unit": "", "coverage": 1.0, "free": clean[1], "scans": clean[2], "ended": clean[3]}]
    for kind, (unit, factor, settings) in kinds.items():
        for i, level in enumerate(settings):
            seen, free, scans, ended = played[f"{kind}-{i}".replace(", ", "-")]
            rows.append({"kind": kind, "level": level * factor, "unit": unit, "coverage": seen / clean[0], "free": free, "scans": scans, "ended": ended})
    return rows


def table(scenes):
    print("| scene | noise | level | coverage of the clean run's [%] | falsely free [%] | scans | ended |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for scene, rows in scenes.items():
        for row in rows:
            figures = f"{100 * row['coverage']:.2f} | {100 * row['free']:.3f} | {row['scans']:.1f} | {'yes' if row['ended'] == 1.0 else 'no'}"
            print(f"| {scene} | {row['kind']} | {row['level']:g} {row['unit']} | {figures} |")


def verdict(scenes):
    """Whether every goal row holds."""
    good = True
    for scene, rows in scenes.items():
        for row in rows:
            if row["kind"].startswith("goal"):
                holds = row["coverage"] >= COVERAGE and row["free"] <= FREE and row["ended"] == 1.0
                print(f"{scene}, {row['kind']}: {'holds' if holds else 'MISSED'}")
                good = good and holds
    return good


def picture(scenes):
    """One column a kind of noise, coverage above and falsely free volume below."""
    kinds = [kind for kind in curves(1.0) if not kind.startswith("goal")]
    width, height, gap = 190, 130, 50
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{len(kinds) * (width + gap) + gap}" height="{2 * (height + gap) + gap}" '
           'font-family="sans-serif" font-size="11">', '<rect width="100%" height="100%" fill="white"/>']  # fmt: skip
    for column, kind in enumerate(kinds):
        for line, (key, title) in enumerate((("coverage", "coverage of the clean run's [%]"), ("free", "falsely free [%]"))):
            left, top = gap + column * (width + gap), gap + line * (height + gap)
            chosen = {s: [r for r in rows if r["kind"] in ("clean", kind)] for s, rows in scenes.items()}
            most_x = max(r["level"] for rows in chosen.values() for r in rows) or 1.0
            values = [100 * r[key] for rows in scenes.values() for r in rows]
            low, high = (min([98.0, *values]), 100.5) if key == "coverage" else (0.0, max([0.15, *values]))
            unit = next(r["unit"] for rows in scenes.values() for r in rows if r["kind"] == kind)
            goal = top + height * (1 - (100 * (COVERAGE if key == "coverage" else FREE) - low) / (high - low))
            out.append(f'<rect x="{left}" y="{top}" width="{width}" height="{height}" fill="none" stroke="#999"/>')
            out.append(f'<line x1="{left}" x2="{left + width}" y1="{goal:.1f}" y2="{goal:.1f}" stroke="#999" stroke-dasharray="4 3"/>')
            out.append(f'<text x="{left}" y="{top - 6}">{title}</text>')
            out.append(f'<text x="{left + width}" y="{top + height + 14}" text-anchor="end">{kind} [{unit}], to {most_x:g}</text>')
            out.append(f'<text x="{left - 4}" y="{top + 10}" text-anchor="end">{high:.4g}</text>')
            out.append(f'<text x="{left - 4}" y="{top + height}" text-anchor="end">{low:.4g}</text>')
            for scene, rows in chosen.items():
                points = [(left + width * r["level"] / most_x, top + height * (1 - (100 * r[key] - low) / (high - low))) for r in rows]
                way = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
                colour = COLOURS.get(scene, "#57606a")
                out.append(f'<polyline points="{way}" fill="none" stroke="{colour}" stroke-width="2"/>')
                out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in points]
    for i, scene in enumerate(scenes):
        out.append(f'<text x="{gap + 90 * i}" y="18" font-size="14" fill="{COLOURS.get(scene, "#57606a")}">{scene}</text>')
    return "\n".join([*out, "</svg>\n"])


def main():
    given = options()
    Path(given.output).mkdir(parents=True, exist_ok=True)
    scenes = {scene: rows_of(given, scene) for scene in given.scenes}
    table(scenes)
    good = verdict(scenes)
    (Path(given.output) / "noise.svg").write_text(picture(scenes))
    (Path(given.output) / "noise.json").write_text(json.dumps(scenes, indent=1) + "\n")
    raise SystemExit(0 if good else 1)


if __name__ == "__main__":
    main()
