# SPDX-License-Identifier: Apache-2.0
"""The tree keeps its rules, and the checker finds every kind of breach in made-up trees."""

from pathlib import Path

import layers
import pytest

SPDX = "// SPDX-License-Identifier: Apache-2.0\n"
LAYERS = "base\ngeometry\nscan\nsurface | planner | io\nexplore | world\naudit\nsession\n"


@pytest.fixture
def tree(tmp_path):
    """Writes files into a made-up tree; returns its root."""
    (tmp_path / "src/vantage").mkdir(parents=True)
    (tmp_path / "src/vantage/LAYERS").write_text(LAYERS)

    def write(name, text="", licence=SPDX):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(licence + text)
        return tmp_path

    return write


def breaches(root):
    return [(str(path), line, reason) for path, line, reason in layers.check_tree(root)]


def test_this_tree_keeps_the_rules():
    root = Path(__file__).resolve().parents[2]
    assert [f"{path}:{line}: {reason}" for path, line, reason in breaches(root)] == []


def test_good_tree_passes(tree):
    tree("src/vantage/surface/tree.h", '#include "vantage/base/error.h"\n#include "vantage/surface/fit.h"\n#include <vector>\n')
    tree("src/vantage/world/lidar.h", '#include "vantage/scan/scan.h"\n')
    tree("src/vantage/geometry/clip_2d.cpp", "if constexpr (Dim == 2) {}\n")
    tree("src/vantage/geometry/clip_test.cpp", "EXPECT_EQ(n, Dim == 2 ? 1 : 4);\n")
    tree("src/vantage/geometry/clip.cpp", "// only where Dim == 2\nfor (int a = 0; a < Dim; ++a) {}\nvalue[Dim - 1] = h;\n")
    root = tree("apps/vantage/main.cpp", '#include "vantage/session/run.h"\n#include "vantage/world/scene.h"\n')
    assert breaches(root) == []


@pytest.mark.parametrize(
    "file, text, line, reason",
    [
        ("src/vantage/base/error.h", '#include "vantage/geometry/vec.h"\n', 2, "base may not include geometry, which stands above it"),
        ("src/vantage/surface/tree.cpp", '#include <vector>\n  # include <vantage/planner/plan.h>\n', 3, "surface and planner are siblings"),
        ("src/vantage/world/lidar.cpp", '#include "vantage/surface/tree.h"\n', 2, "world may not include surface"),
        ("src/vantage/explore/loop.cpp", '\n#include "vantage/io/ply.h"\n', 3, "explore may not include io"),
        ("src/vantage/explore/loop.cpp", '#include "vantage/world/scene.h"\n', 2, "explore may not include world"),
        ("src/vantage/explore/loop.cpp", '#include "vantage/audit/score.h"\n', 2, "explore may not include audit"),
        ("src/vantage/scan/scan.cpp", '#include "vantage/tools/x.h"\n', 2, "module tools is not in LAYERS"),
        ("src/vantage/extras/x.cpp", "", 1, "folder extras is not in LAYERS"),
        ("src/vantage/scan/scan.cpp", "if (Dim == 2) return;\n", 2, "branch on the dimension outside a _2d or _3d file"),
        ("src/vantage/scan/scan.cpp", "\nif constexpr (Dim == 3) {}\n", 3, "branch on the dimension outside a _2d or _3d file"),
        ("src/vantage/scan/scan.cpp", "return Dim > 2 ? a : b;\n", 2, "branch on the dimension outside a _2d or _3d file"),
    ],
)
def test_breach_is_found(tree, file, text, line, reason):
    assert breaches(tree(file, text)) == [(file, line, reason)]


def test_header_for_tests_alone_may_ask_for_the_dimension(tree):
    tree("src/vantage/scan/sample.h", "if constexpr (Dim == 3) {}\n")
    tree("src/vantage/scan/scan_test.cpp", '#include "vantage/scan/sample.h"\n')
    assert breaches(tree("src/vantage/scan/scan.cpp")) == []
    assert len(breaches(tree("src/vantage/scan/scan.cpp", '#include "vantage/scan/sample.h"\n'))) == 1


def test_breach_in_a_comment_is_none(tree):
    assert breaches(tree("src/vantage/base/error.h", '/*\n#include "vantage/geometry/vec.h"\n*/ // Dim == 2\n')) == []


@pytest.mark.parametrize("definition", ["inline constexpr int kLanes = 8;", "struct Lanes {", "template <int Dim>\nclass Lanes final : Base {", "enum class Lanes : int { a };"])
def test_name_of_two_things_is_found(tree, definition):
    tree("src/vantage/scan/one.h", f"namespace vantage {{\n{definition}\n")
    root = tree("src/vantage/surface/two.h", f"namespace vantage {{\n\n{definition}\n")
    line, name = 3 + len(definition.splitlines()), "kLanes" if "kLanes" in definition else "Lanes"
    assert breaches(root) == [("src/vantage/surface/two.h", line, f"vantage::{name} is also in src/vantage/scan/one.h")]


def test_same_name_in_another_namespace_in_a_type_or_only_declared_is_none(tree):
    tree("src/vantage/scan/one.h", "namespace vantage {\nstruct Lanes {\n  struct Row {};\n};\nclass Scan;\n")
    assert breaches(tree("src/vantage/surface/two.h", "namespace vantage {\nstruct Row {};\nclass Scan;\nnamespace samples {\nstruct Lanes {};\n")) == []


@pytest.mark.parametrize("folder", sorted(layers.REFUSED_FOLDERS))
def test_refused_folder(tree, folder):
    root = tree(f"tests/{folder}/x.py", licence="# " + SPDX)
    assert breaches(root) == [(f"tests/{folder}", 0, f"folder name {folder} is refused: say what it holds")]


@pytest.mark.parametrize("file", ["src/vantage/base/x.cpp", "tests/x.py", "cmake/x.cmake", "tooling/x"])
def test_missing_licence_line(tree, file):
    text = "#!/bin/sh\n" if "." not in file else "\n"
    assert breaches(tree(file, text, licence="")) == [(file, 1, "the line SPDX-License-Identifier: Apache-2.0 is missing")]


def test_main_prints_file_and_line_and_fails(tree, capsys):
    root = tree("src/vantage/base/error.h", '#include "vantage/io/ply.h"\n')
    assert layers.main([str(root)]) == 1
    assert capsys.readouterr().out.splitlines()[0] == "src/vantage/base/error.h:2: base may not include io, which stands above it"


def test_empty_tree_fails(tree, tmp_path):
    assert layers.main([str(tmp_path)]) == 1
