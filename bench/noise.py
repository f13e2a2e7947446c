# SPDX-License-Identifier: Apache-2.0
"""What the scanner's imperfections cost: whole explorations with noise in pose and range, outliers (as they are and filtered) and drop-out, beside
the clean one. Prints a table, draws what each level costs (OUT/noise.svg) and the coverage after each scan (OUT/noise-scans.svg), and says whether the goals hold:
with noise of half a voxel, 5 % outliers, filtered, and 30 % drop-out at least 99 % of the clean run's coverage, and at most 0.1 % of the volume falsely free.

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
    parser.add_argument("--kinds", help="only these, separated by commas")
    parser.add_argument("--set", action="append", default=[], metavar="STAGE.OPTION=VALUE", help="an option of every run")
    parser.add_argument("--threads", type=int, default=0, help="of the program; 0: all cores")
    parser.add_argument("-o", "--output", default="build/noise")
    return parser.parse_args()


def voxel_of(given, scene):
    """The lattice spacing of the scene's runs [m]."""
    text = subprocess.run([given.program, "config", "dump", scene], capture_output=True, text=True, check=True).stdout
    own = [option.split("=")[1] for option in given.set if option.startswith("explore.voxel=")]
    return float(own[0] if own else next(line.split("=")[1] for line in text.splitlines() if line.startswith("voxel =")))


def curves(voxel, only=None):
    """Of each kind of noise: unit, factor of the figures shown, and settings level by level."""
    half = voxel / 2
    worst = "sensor.outliers=0.05,sensor.dropout=0.3,sensor.confirmed=true"
    kinds = {
        "place": ("cm", 100, {s: f"sensor.pose_noise={s}" for s in (0.02, 0.05, 0.1, 0.2)}),
        "turn": ("degrees", 1, {s: f"sensor.pose_noise_deg={s}" for s in (0.1, 0.25, 0.5, 1.0)}),
        "range": ("cm", 100, {s: f"sensor.range_noise={s:g}" for s in (half / 4, half / 2, half, voxel)}),
        "range smoothed": ("cm", 100, {s: f"sensor.range_noise={s:g},sensor.smoothed=true" for s in (half / 4, half / 2, half, voxel)}),
        "outliers": ("%", 100, {s: f"sensor.outliers={s}" for s in (0.01, 0.05, 0.1, 0.2)}),
        "outliers filtered": ("%", 100, {s: f"sensor.outliers={s},sensor.confirmed=true" for s in (0.01, 0.05, 0.1, 0.2)}),
        "drop-out": ("%", 100, {s: f"sensor.dropout={s}" for s in (0.1, 0.3, 0.5)}),
        "goal range": ("cm", 100, {half: f"sensor.range_noise={half:g},{worst},sensor.smoothed=true"}),
        "goal place": ("cm", 100, {half: f"sensor.pose_noise={half:g},{worst}"}),
    }
    return {kind: value for kind, value in kinds.items() if only is None or kind in [name.strip() for name in only.split(",")]}


def mean(rows):
    return [sum(column) / len(column) for column in zip(*rows)]


def play(given, scene, levels):
    """Every level's runs: name -> (share seen, share falsely free, scans, ended) and the share seen after each scan, each a mean of the seeds."""
    command = [given.program, "audit", scene, "--scene-start", "--starts", "1", "--to-the-end", "--cap", "20", "--variants", "none", "-q", "--json"]
    command += ["--threads", str(given.threads)]
    command += ["-o", str(Path(given.output) / scene)] + [word for option in given.set for word in ("--set", option)]
    for name, settings in levels.items():
        for seed in range(1, given.seeds + 1):
            command += ["--variant", f"{name}-{seed}={settings + ',' if settings else ''}sensor.seed={seed}"]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        raise SystemExit(result.stderr)
    runs, courses = {}, {}
    for run in json.loads(result.stdout)["scenes"][0]["runs"]:
        name = run["variant"].rsplit("-", 1)[0]
        figures = run["coverage"][-1], run["false_free_m3"] / run["reference_m3"], run["scans"], float(run["verdict"]["finished"])
        runs.setdefault(name, []).append(figures)
        courses.setdefault(name, []).append(run["coverage"])
    for all_ in courses.values():  # A run that has ended stays where it is.
        longest = max(len(course) for course in all_)
        all_[:] = [course + [course[-1]] * (longest - len(course)) for course in all_]
    return {name: (*mean(all_runs), mean(courses[name])) for name, all_runs in runs.items()}


def rows_of(given, scene):
    kinds = curves(voxel_of(given, scene), given.kinds)
    levels = {"clean": ""}
    levels.update({f"{kind}-{i}".replace(" ", "-"): s for kind, (_, _, all_) in kinds.items() for i, s in enumerate(all_.values())})
    played = play(given, scene, levels)
    clean = played["clean"][0]

    def row(name, kind, level, unit):
        seen, free, scans, ended, course = played[name]
        return {"kind": kind, "level": level, "unit": unit, "coverage": seen / clean, "free": free, "scans": scans, "ended": ended, "course": course}

    rows = [row("clean", "clean", 0.0, "")]
    for kind, (unit, factor, settings) in kinds.items():
        rows += [row(f"{kind}-{i}".replace(" ", "-"), kind, level * factor, unit) for i, level in enumerate(settings)]
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
    played = {row["kind"] for rows in scenes.values() for row in rows}
    kinds = [kind for kind in curves(1.0) if not kind.startswith("goal") and kind in played]
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


def scan_by_scan(scenes):
    """One frame a scene: coverage after each scan, of the clean run and of each kind's highest level."""
    width, height, gap = 420, 300, 50
    colours = ["#24292f", "#1f6feb", "#8250df", "#d1242f", "#fb8500", "#bf8700", "#1a7f37", "#57606a", "#0aa2c0", "#e85aad"]
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{len(scenes) * (width + 4 * gap) + gap}" height="{height + 2 * gap}" '
           'font-family="sans-serif" font-size="11">', '<rect width="100%" height="100%" fill="white"/>']  # fmt: skip
    for column, (scene, rows) in enumerate(scenes.items()):
        left, top = gap + column * (width + 4 * gap), gap
        last = {row["kind"]: row for row in rows}
        most = max(len(row["course"]) for row in last.values())
        out.append(f'<text x="{left}" y="{top - 14}" font-size="14">{scene}: seen [%] after each scan</text>')
        out.append(f'<rect x="{left}" y="{top}" width="{width}" height="{height}" fill="none" stroke="#999"/>')
        out.append(f'<text x="{left + width}" y="{top + height + 14}" text-anchor="end">{most} scans</text>')
        out += [f'<text x="{left - 4}" y="{top + height * (1 - share) + 4:.0f}" text-anchor="end">{100 * share:.0f}</text>' for share in (0.0, 0.5, 1.0)]
        for k, row in enumerate(last.values()):
            points = [(left + width * (i + 1) / most, top + height * (1 - seen)) for i, seen in enumerate(row["course"])]
            way = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
            out.append(f'<polyline points="{way}" fill="none" stroke="{colours[k % len(colours)]}" stroke-width="1.5"/>')
            label = f"{row['kind']} {row['level']:g} {row['unit']}" if row["unit"] else row["kind"]
            out.append(f'<text x="{left + width + 8}" y="{top + 14 + 15 * k}" fill="{colours[k % len(colours)]}">{label}</text>')
    return "\n".join([*out, "</svg>\n"])


def main():
    given = options()
    Path(given.output).mkdir(parents=True, exist_ok=True)
    scenes = {scene: rows_of(given, scene) for scene in given.scenes}
    table(scenes)
    good = verdict(scenes)
    (Path(given.output) / "noise.svg").write_text(picture(scenes))
    (Path(given.output) / "noise-scans.svg").write_text(scan_by_scan(scenes))
    (Path(given.output) / "noise.json").write_text(json.dumps(scenes, indent=1) + "\n")
    raise SystemExit(0 if good else 1)


if __name__ == "__main__":
    main()
