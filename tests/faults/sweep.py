#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fault sweep: breaks a tiny run at each of its I/O calls in turn and checks that nothing acknowledged is lost and that going on ends in the same bytes.

    tests/faults/sweep.py                    every call: the call fails with ENOSPC, with EIO, the process is killed there
    tests/faults/sweep.py --kills 1000       kills at random times as well
    tests/faults/sweep.py --share 0.05       a sample, the same each time

The calls are counted and broken by strace. A kill at a call strikes before it is carried out, so that the kill at the next one is the one after it.
Commands: explore (a new run), resume (of a log with a torn end), remove (two scans of a run), force (a run replaced by another), first (scans into a
new folder by `next`) and next (a scan added to it). Of each: after the fault the log must hold every scan that was acknowledged, bit for bit; an error
must be one line and a documented exit code; without an error the result must be whole; the command given again (with --resume where a run is there)
must end in the bytes of an undisturbed run, and leave nothing else behind.
"""

import argparse
import collections
import dataclasses
import os
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

PROGRAM = Path(__file__).resolve().parents[2] / "build/dev/bin/vantage"
CALLS = "openat,read,pread64,write,pwrite64,fsync,fdatasync,ftruncate,rename,renameat,renameat2,close,mkdir,mkdirat,unlink,unlinkat,rmdir,link,linkat,flock,newfstatat,getdents64"
PART = re.compile(r"\.\d+-(\d+)\.part")  # Of a file that is being written.
READING = ("read", "pread64", "newfstatat", "getdents64")
SCENE = ["discs", "--grid", "24", "--step-deg", "4", "--threads", "1", "--set", "explore.snapshots=false"]
OLD_SCENE = ["discs", "--grid", "20", "--step-deg", "4", "--threads", "1"]
SCANS = "10"
NEXT = ["--grid", "12", "--threads", "1"]


def records(log):
    """The whole records at the begin of a log, by an independent reader."""
    found, at = [], 16
    while at + 16 <= len(log):
        magic, length, payload_sum, head_sum = struct.unpack_from("<4sIII", log, at)
        payload = log[at + 16 : at + 16 + length]
        if magic != b"SCAN" or zlib.crc32(log[at : at + 12]) != head_sum or zlib.crc32(payload) != payload_sum or len(payload) != length:
            break
        found.append(payload)
        at += 16 + length
    return found


def log_of(folder):
    path = folder / "scans.log"
    return records(path.read_bytes()) if path.exists() else []


def content(root):
    """All that lies below root but what may differ between equal runs."""
    return {str(p.relative_to(root)): p.read_bytes() if p.is_file() else None for p in sorted(root.rglob("*")) if p.name not in ("timing.json", "scans.log.bak")}


class Broken(Exception):
    """What must not be."""


def need(condition, what):
    if not condition:
        raise Broken(what)


class Case:
    """A command on a folder, and how it may be broken. `start` holds what is there before."""

    def __init__(self, name, bench, start, command):
        self.name, self.bench, self.start, self.command = name, bench, start, command
        self.root = bench.folder / "root"
        self.run = self.root / "run"
        self.before = log_of(start / "run")
        self.gone_on = set()
        self.fresh()
        begin = time.monotonic()
        result = bench.vantage(self.arguments())
        self.seconds = time.monotonic() - begin
        assert result.returncode == 0, result.stderr
        self.reference = content(self.root)
        self.after = log_of(self.run)

    def fresh(self):
        shutil.rmtree(self.root, ignore_errors=True)
        shutil.copytree(self.start, self.root)

    def arguments(self):
        return self.command(self.root)

    def lines(self, result):
        """Scans that the output acknowledges."""
        return len(re.findall(r"^scan +\d+ ", result.stderr, re.MULTILINE))

    def acknowledged(self, result):
        """Records that must be there after this output, in order."""
        return self.after[: max(len(self.before), self.lines(result))]

    def check_log(self, result):
        log, wanted = log_of(self.run), self.acknowledged(result)
        need(log[: len(wanted)] == wanted, f"lost: {len(wanted)} scans acknowledged, {len(log)} in the log")
        need(log == self.after[: len(log)], "the log holds another scan")

    def again(self):
        """Commands that a user would give then, the first that works."""
        return [self.arguments()]


class Explore(Case):
    def again(self):
        arguments = self.arguments()
        return [arguments if "--resume" in arguments else [*arguments, "--resume"], arguments]


class Remove(Case):
    def acknowledged(self, result):
        return self.after

    def check_log(self, result):
        need(log_of(self.run) in (self.before, self.after), "the log is neither that before nor that after")

    def again(self):
        arguments = self.arguments()
        return [arguments if log_of(self.run) == self.before else arguments[: arguments.index("--remove")]]


class Force(Case):
    def acknowledged(self, result):
        return self.after[: self.lines(result)]

    def check_log(self, result):
        old = self.before in (log_of(self.run), log_of(self.root / "run.replaced.part"))
        new = log_of(self.run)
        need(old or (new and new == self.after[: len(new)]), "neither the old run nor the new one is there")
        need(old or len(new) >= self.lines(result), "a scan is lost")


class Next(Case):
    def acknowledged(self, result):
        return self.after if result.stdout else self.before

    def again(self):
        arguments = self.arguments()
        return [["next", str(self.run), *(a for a in arguments[1:] if a not in ("-o", str(self.run)))], arguments]


class Bench:
    def __init__(self, program, folder):
        self.program, self.folder = str(program), Path(folder)

    def vantage(self, arguments, prefix=()):
        out = subprocess.run([*prefix, self.program, *arguments], capture_output=True, cwd="/", timeout=120)
        return subprocess.CompletedProcess(out.args, out.returncode, out.stdout.decode(errors="replace"), out.stderr.decode(errors="replace"))

    def must(self, *arguments):
        result = self.vantage([str(a) for a in arguments])
        assert result.returncode == 0, result.stderr

    def cases(self, wanted):
        makers = {"explore": self.explore, "resume": self.resume, "remove": self.remove, "force": self.force, "first": self.first, "next": self.next}
        for name in wanted:
            yield makers[name](name, self.start(name))

    def start(self, name):
        folder = self.folder / name
        folder.mkdir()
        return folder

    def explore(self, name, start):
        return Explore(name, self, start, lambda root: ["explore", *SCENE, "--max-scans", SCANS, "-o", str(root / "run")])

    def resume(self, name, start):
        """A run that was killed while its sixth scan was written, and an output."""
        run = start / "run"
        self.must("explore", *SCENE, "--max-scans", 6, "-o", run)
        for path in run.iterdir():
            if path.is_file() and path.name not in ("scans.log", "scenario.toml", "manifest.json"):
                path.unlink()
        log = (run / "scans.log").read_bytes()
        (run / "scans.log").write_bytes(log[:-100])
        (run / "result.json.2147483647-1.part").write_bytes(b"{")
        (run / "scans/000.ply.2147483647-2.part").write_bytes(b"ply")
        return Explore(name, self, start, lambda root: ["explore", *SCENE, "--resume", "--max-scans", SCANS, "-o", str(root / "run")])

    def remove(self, name, start):
        self.must("explore", *SCENE, "--max-scans", 6, "-o", start / "run")
        return Remove(name, self, start, lambda root: ["explore", "--resume", "--threads", "1", "--max-scans", "4", "-o", str(root / "run"), "--remove", "1", "--remove", "4"])

    def force(self, name, start):
        self.must("explore", *OLD_SCENE, "--max-scans", 2, "-o", start / "run")
        return Force(name, self, start, lambda root: ["explore", *SCENE, "--max-scans", "3", "--force", "-o", str(root / "run")])

    def clouds(self):
        """Two scans, as files."""
        places = ("3,3,1.5", "7,6,1.5")
        files = [self.folder / f"cloud{k}.ply" for k in range(2)]
        for file, place in zip(files, places):
            if not file.exists():
                self.must("scan", "pipes:cylinders=3", "--step-deg", 8, "--at", place, "-o", file, "-q")
        return [str(file) for file in files], places

    def first(self, name, start):
        files, places = self.clouds()
        return Next(name, self, start, lambda root: ["next", *files, "--at", places[0], "--at", places[1], *NEXT, "-o", str(root / "run")])

    def next(self, name, start):
        files, places = self.clouds()
        self.must("next", files[0], "--at", places[0], *NEXT, "-o", start / "run")
        return Next(name, self, start, lambda root: ["next", str(root / "run"), files[1], "--at", places[1], "--threads", "1"])


@dataclasses.dataclass
class Site:
    call: str
    number: int  # Which call of that name.
    text: str


def strace(bench, more):
    return ["strace", "-f", "-y", "-qq", "-s", "0", "-o", str(bench.folder / "trace"), *more]


def sites_of(case):
    """The calls of the command on its files and its output."""
    case.fresh()
    result = case.bench.vantage(case.arguments(), strace(case.bench, ["-e", "signal=none", "-e", f"trace={CALLS}"]))
    assert result.returncode == 0, result.stderr
    counts, found, processes = collections.Counter(), [], set()
    for line in (case.bench.folder / "trace").read_text().splitlines():
        process, _, text = line.partition(" ")
        match = re.match(r"\s*(\w+)\((.*)", text)
        if not match:
            continue
        call, rest = match.groups()
        counts[call] += 1
        processes.add(process)
        if str(case.root) in rest or rest.startswith(("1<", "2<")):
            found.append(Site(call, counts[call], text.strip().replace(str(case.root), "ROOT")))
    assert len(processes) == 1, "more than one thread: the calls cannot be counted"
    return found


def broken_lines(stderr):
    """Lines that are neither progress nor a warning."""
    return [line for line in stderr.splitlines() if not re.match(r"scan +\d+ |\w+: \dD, |vantage: warning: ", line)]


def check_fault(case, site, kind, result):
    killed = kind == "KILL"
    if killed:
        need(result.returncode in (-9, 137), f"was not killed: exit code {result.returncode}")
    elif result.returncode == 0:
        need(broken_lines(result.stderr) == [], f"an error and exit code 0: {result.stderr}")
        # What a stopped process has left may stay until the next time.
        now = {name: data for name, data in content(case.root).items() if not name.endswith(".part")}
        need(now == case.reference, "exit code 0, but the result is not whole")
    else:
        # What a folder holds cannot be told where its entries cannot be looked up.
        codes = (2, 3) if site.call == "newfstatat" else (3,)
        need(result.returncode in codes, f"exit code {result.returncode}: {result.stderr}")
        lines = broken_lines(result.stderr)
        quiet = site.call == "write" and "(2<" in site.text
        need(quiet or (len(lines) == 1 and lines[0].startswith("vantage: ")), f"not one line: {lines}")
    case.check_log(result)
    go_on(case)


def state(case):
    """All that a later command can find, but the numbers of processes."""
    files = [p for p in case.root.rglob("*") if p.name != "timing.json"]
    names = [PART.sub(r".PID-\1.part", str(p.relative_to(case.root))) for p in files]
    return str(case.again()), tuple(sorted((name, p.is_file() and p.read_bytes()) for name, p in zip(names, files)))


def go_on(case):
    """The command again, undisturbed; once for all faults that leave the same bytes."""
    key = hash(state(case))
    if key in case.gone_on:
        return
    begun = bool(log_of(case.run))
    for arguments in case.again():
        result = case.bench.vantage(arguments)
        if result.returncode == 0 or begun:
            break
    need(result.returncode == 0, f"cannot go on: {result.returncode} {result.stderr.splitlines()[-1:]}")
    now = content(case.root)
    different = sorted(name for name in now.keys() | case.reference.keys() if now.get(name) != case.reference.get(name))
    need(not different, f"other bytes in the end: {different}")
    case.gone_on.add(key)


def aim(case, text):
    """What tells a call from others: its name and its files."""
    text = PART.sub(r".PID-\1.part", text.replace(str(case.root), "ROOT"))
    return re.findall(r"^\s*\w+\(|ROOT[^\">]*|\([12]<", text.partition(" = ")[0])


def calls_of(trace):
    """Lines of a trace by strace -f; a call that another thread's line interrupts is put together again."""
    begun = {}
    for line in trace.splitlines():
        process, _, text = line.partition(" ")
        text = text.strip()
        if text.endswith("<unfinished ...>"):
            begun[process] = text.removesuffix("<unfinished ...>")
        elif text.startswith("<... ") and process in begun:
            yield begun.pop(process) + text.partition(" resumed>")[2]
        else:
            yield text


def struck(case, site):
    """Whether the call that was broken is the one that was meant."""
    broken = [call for call in calls_of((case.bench.folder / "trace").read_text()) if call.endswith(("(INJECTED)", "= ?"))]
    return bool(broken) and aim(case, broken[0]) == aim(case, site.text)


def try_site(case, site, kind):
    """Breaks one call; the reason why that is not as it must be, or nothing."""
    case.fresh()
    how = "signal=KILL" if kind == "KILL" else f"error={kind}"
    more = ["-e", f"trace={site.call}", "-e", f"inject={site.call}:{how}:when={site.number}"]
    try:
        result = case.bench.vantage(case.arguments(), strace(case.bench, more))
        need(struck(case, site), "the fault did not strike there")
        check_fault(case, site, kind, result)
    except Broken as reason:
        return str(reason)
    return None


def sample(sites, share):
    """A part of the sites, evenly, and the first that writes to the log; the same each time."""
    if share >= 1.0:
        return sites
    step = round(1 / share)
    log = next(k for k, site in enumerate(sites) if site.call == "pwrite64")
    return [site for k, site in enumerate(sites) if k % step == step // 2 or k == log]


def kinds(site):
    """What may befall a call. One that only reads cannot meet a full disk, and leaves nothing that the next call would not."""
    return ("EIO",) if site.call in READING else ("ENOSPC", "EIO", "KILL")


def sweep(bench, cases, share, say):
    """All faults; returns their number and the failures."""
    faults, failures = 0, []
    for case in bench.cases(cases):
        begin, sites = time.monotonic(), sites_of(case)
        chosen, bad = sample(sites, share), 0
        tries = [(site, kind) for site in chosen for kind in kinds(site)] if share >= 1.0 else [(site, kinds(site)[k % len(kinds(site))]) for k, site in enumerate(chosen)]
        for site, kind in tries:
            reason = try_site(case, site, kind)
            if reason is not None:
                bad += 1
                failures.append(f"{case.name}: {kind} at {site.call} {site.number}: {site.text[:150]}: {reason}")
                say("  " + failures[-1])
        faults += len(tries)
        say(f"{case.name:8} {len(sites):4} calls  {len(tries):5} faults  {len(case.gone_on):4} states  {bad:3} failed  {time.monotonic() - begin:6.0f} s")
    return faults, failures


def kill_after(bench, arguments, seconds):
    process = subprocess.Popen([bench.program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd="/")
    try:
        out, err = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        process.kill()
        out, err = process.communicate()
    return subprocess.CompletedProcess(arguments, process.returncode, out.decode(errors="replace"), err.decode(errors="replace"))


def random_kills(bench, wanted, seed, say):
    """Kills at random times, one after the other on the same folder until the run is through; then anew."""
    chance = random.Random(seed)
    cases = list(bench.cases(("explore", "next")))
    kills, rounds, failures, begin = 0, 0, [], time.monotonic()
    while kills < wanted:
        case = cases[0] if rounds % 5 < 4 else cases[1]
        case.fresh()
        rounds += 1
        arguments = case.arguments()
        try:
            while True:
                result = kill_after(bench, arguments, chance.uniform(0.0, 1.1 * case.seconds))
                if result.returncode == 0:
                    need(content(case.root) == case.reference, "other bytes in the end")
                    break
                need(result.returncode == -9, f"exit code {result.returncode}: {result.stderr}")
                kills += 1
                case.check_log(result)
                arguments = case.again()[0 if log_of(case.run) else -1]
                if kills >= wanted:
                    go_on(case)
                    break
        except Broken as reason:
            failures.append(f"{case.name}, round {rounds}: {reason}")
            say("  " + failures[-1])
    say(f"{kills} kills at random times in {rounds} runs, {len(failures)} failed, {time.monotonic() - begin:.0f} s")
    return failures


def can_trace():
    """Why calls cannot be broken here; nothing if they can."""
    if shutil.which("strace") is None:
        return "strace is not installed"
    with tempfile.NamedTemporaryFile() as trace:
        result = subprocess.run(["strace", "-f", "-qq", "-o", trace.name, "-e", "inject=unlink:error=EIO", "true"], capture_output=True, text=True)
    return None if result.returncode == 0 else f"strace may not trace here: {result.stderr.strip().splitlines()[-1:]}"


def fast_folder():
    """In memory where that is possible: the calls count, not the disk."""
    return "/dev/shm" if os.access("/dev/shm", os.W_OK) else None


ALL_CASES = ("explore", "resume", "remove", "force", "first", "next")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=os.environ.get("VANTAGE_PROGRAM", PROGRAM))
    parser.add_argument("--cases", default=",".join(ALL_CASES), help="some of the commands")
    parser.add_argument("--share", type=float, default=1.0, help="part of the calls")
    parser.add_argument("--kills", type=int, default=0, help="so many kills at random times")
    parser.add_argument("--only-kills", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    failures = []
    with tempfile.TemporaryDirectory(dir=fast_folder()) as folder:
        bench = Bench(Path(arguments.program).resolve(), folder)
        say = lambda text: print(text, flush=True)
        if not arguments.only_kills:
            reason = can_trace()
            if reason:
                sys.exit(reason)
            faults, failures = sweep(bench, arguments.cases.split(","), arguments.share, say)
            say(f"{faults} faults, {len(failures)} failed")
    if arguments.kills:
        with tempfile.TemporaryDirectory(dir=fast_folder()) as folder:
            failures += random_kills(Bench(Path(arguments.program).resolve(), folder), arguments.kills, arguments.seed, print)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
