# SPDX-License-Identifier: Apache-2.0
"""What the Python tests share: the program, real data, runs."""

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="session")
def vantage():
    """Runs the program: vantage("explore", "planar", ...) -> CompletedProcess with text output. VANTAGE_PROGRAM names another one."""
    program = Path(os.environ.get("VANTAGE_PROGRAM", ROOT / "build/dev/bin/vantage"))
    assert program.exists(), f"{program} is not built; ./check builds it"

    def run(*arguments, timeout=300, **options):
        command = [str(program), *(str(argument) for argument in arguments)]
        return subprocess.run(command, capture_output=True, text=True, timeout=timeout, **options)

    return run


@pytest.fixture(scope="session")
def data():
    """Path of a file of real data: data("maps2d/x.yaml"); skips the test where it is not there (VANTAGE_DATA, default ../shared/data)."""
    folder = Path(os.environ.get("VANTAGE_DATA", ROOT / "../shared/data"))

    def find(name):
        if not (folder / name).exists():
            pytest.skip(f"{name} is missing (VANTAGE_DATA)")
        return folder / name

    return find
