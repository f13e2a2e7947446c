# SPDX-License-Identifier: Apache-2.0
"""Runs that meet faults: a sample of the sweep (sweep.py, which does all of them), and a file that may not grow."""

import resource
import subprocess
import tempfile

import pytest
import sweep


@pytest.fixture
def bench(vantage):
    with tempfile.TemporaryDirectory(dir=sweep.fast_folder()) as folder:
        yield sweep.Bench(vantage("--version").args[0], folder)


@pytest.mark.parametrize(("case", "share"), [("explore", 0.04), ("next", 0.03)])
def test_a_sample_of_the_sweep(bench, case, share):
    reason = sweep.can_trace()
    if reason:
        pytest.skip(f"fault sweep: {reason}")
    faults, failures = sweep.sweep(bench, [case], share, print)
    assert faults >= 6 and failures == []


@pytest.mark.parametrize("limit", [2000, 2370])
def test_a_file_that_may_not_grow(bench, limit):
    """The system really writes a part of a scan (at 2,000 bytes) or nothing of it (2,370: where the fifth ends), and no more."""
    (case,) = bench.cases(["explore"])
    case.fresh()
    size = resource.RLIMIT_FSIZE
    result = subprocess.run([bench.program, *case.arguments()], capture_output=True, text=True, restore_signals=False,  # SIGXFSZ stays ignored.
                            preexec_fn=lambda: resource.setrlimit(size, (limit, limit)))
    whole = (limit - 16) // (16 + len(case.after[0]))
    assert result.returncode == 3 and sweep.broken_lines(result.stderr) == [f"vantage: {case.run}/scans.log: cannot be written: File too large"]
    assert case.lines(result) == whole == len(sweep.log_of(case.run))
    assert (case.run / "scans.log").stat().st_size == 16 + sum(16 + len(record) for record in case.after[:whole])
    sweep.go_on(case)


def test_killed_at_any_time(bench):
    assert sweep.random_kills(bench, 8, 1, print) == []
