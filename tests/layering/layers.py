#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The rules of the source tree, checked line by line: who may include whom (src/vantage/LAYERS), where the dimension may be asked for,
which folder names are refused, the licence line on top of every source, and that no name stands for two things. `layers.py [ROOT]` prints every breach as FILE:LINE: REASON."""

import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'\s*#\s*include\s*[<"]vantage/([^/">]+)/[^">]+[">]')
DIMENSION = re.compile(r"\bDim\s*[=!<>]=\s*[23]\b|\b[23]\s*[=!]=\s*Dim\b|\bif\s+constexpr\s*\(\s*!?\s*Dim\b|\bDim\s*[<>]\s*[23]\b(?!\s*>)")
CONCEPT = re.compile(r"\bconcept\s+SpatialDim\b")
NAMESPACE = re.compile(r"namespace (\w+(?:::\w+)*) \{")
DEFINITION = re.compile(r"(?:template .*)?inline constexpr [^=({]*?\b(\w+)(?:\[\w*\])?\s*[={(]|(?:struct|class|enum class|enum) (\w+)[^;]*\{")
REFUSED_FOLDERS = {"util", "utils", "common", "misc", "helpers"}
SOURCES = {".h", ".cpp"}
LICENSED = SOURCES | {".py", ".cmake", ".sh"}
TREES = ("src", "apps", "examples", "bench", "tests", "cmake", "tooling", "python", ".ci")

# Beyond the layers: `world` takes of the stages only `scan`; `explore` knows a place only through its sensor.
STAGES = {"surface", "visibility", "belief", "planner"}
FORBIDDEN = {"world": STAGES, "explore": {"world", "audit", "io"}}


def read_layers(path):
    """Module -> number of its line, bottom first."""
    layer = {}
    for number, line in enumerate(path.read_text().splitlines()):
        for module in line.split("#")[0].replace("|", " ").split():
            layer[module] = number
    return layer


def include_breach(layer, module, included):
    """Why `module` may not include `included`, or None. Programs (module None) may include any module."""
    if included not in layer:
        return f"module {included} is not in LAYERS"
    if module is None or module == included:
        return None
    if included in FORBIDDEN.get(module, ()):
        return f"{module} may not include {included}"
    if layer[included] == layer[module]:
        return f"{module} and {included} are siblings"
    if layer[included] > layer[module]:
        return f"{module} may not include {included}, which stands above it"
    return None


def without_comments(text):
    """The text with comments blanked, lines kept."""
    blank = lambda match: re.sub(r"[^\n]", " ", match.group(0)) if match.group(0)[0] == "/" else match.group(0)
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', blank, text, flags=re.S)


def test_headers(root):
    """Headers of the library that only tests include, as paths like `vantage/report/sample_run.h`."""
    includers = {}
    for path in (root / "src/vantage").rglob("*"):
        if path.suffix in SOURCES:
            for header in re.findall(r'#\s*include\s*"(vantage/[^"]+)"', path.read_text()):
                includers.setdefault(header, []).append(path)
    return {header for header, paths in includers.items() if all(path.stem.endswith("_test") for path in paths)}


def check_file(root, path, layer, for_tests=()):
    """Breaches of one C++ source as (path, line, reason)."""
    relative = path.relative_to(root)
    in_library = relative.parts[:2] == ("src", "vantage")
    module = relative.parts[2] if in_library and len(relative.parts) > 3 else None
    if in_library and module not in layer:
        yield relative, 1, f"folder {module} is not in LAYERS"
        return
    split_by_dimension = path.stem.removesuffix("_test").endswith(("_2d", "_3d"))
    for number, line in enumerate(without_comments(path.read_text()).splitlines(), 1):
        match = INCLUDE.match(line)
        reason = include_breach(layer, module, match.group(1)) if match and relative.parts[0] in ("src", "apps") else None
        if reason:
            yield relative, number, reason
        is_test = path.stem.endswith("_test") or "/".join(relative.parts[1:]) in for_tests
        if in_library and not split_by_dimension and not is_test and DIMENSION.search(line) and not CONCEPT.search(line):
            yield relative, number, "branch on the dimension outside a _2d or _3d file"


def defined_names(text):
    """(line, constant or type with its namespace) for those that a header defines outside other types, which begin their lines."""
    space = ""
    for number, line in enumerate(without_comments(text).splitlines(), 1):
        if opened := NAMESPACE.match(line):
            space = opened.group(1)
        elif found := DEFINITION.match(line):
            yield number, f"{space}::{found.group(1) or found.group(2)}"


def double_names(root):
    """Constants and types that two headers of the library define: sources with one of the two each would be linked into nonsense without a word."""
    first = {}
    for path in sorted((root / "src/vantage").rglob("*.h")):
        for number, name in defined_names(path.read_text()):
            known = first.setdefault(name, path)
            if known != path:
                yield path.relative_to(root), number, f"{name} is also in {known.relative_to(root)}"


def needs_licence(path):
    return path.suffix in LICENSED or (not path.suffix and path.name != "LAYERS" and path.read_bytes().startswith(b"#!"))


def check_tree(root):
    """All breaches below `root`: file by file, then the names that two headers define."""
    root = Path(root)
    layer = read_layers(root / "src/vantage/LAYERS")
    breaches = []
    for_tests = test_headers(root)
    for tree in TREES:
        for path in sorted((root / tree).rglob("*")):
            relative = path.relative_to(root)
            if "__pycache__" in relative.parts or path.is_symlink():
                continue
            if path.is_dir():
                if path.name.lower() in REFUSED_FOLDERS:
                    breaches.append((relative, 0, f"folder name {path.name} is refused: say what it holds"))
                continue
            if needs_licence(path) and "SPDX-License-Identifier: Apache-2.0" not in "".join(path.read_text().splitlines(True)[:3]):
                breaches.append((relative, 1, "the line SPDX-License-Identifier: Apache-2.0 is missing"))
            if path.suffix in SOURCES:
                breaches.extend(check_file(root, path, layer, for_tests))
    return breaches + list(double_names(root))


def main(arguments):
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parents[2]
    sources = sum(1 for tree in ("src", "apps") for path in (root / tree).rglob("*") if path.suffix in SOURCES)
    breaches = check_tree(root)
    for path, line, reason in breaches:
        print(f"{path}:{line}: {reason}")
    print(f"{sources} sources, {len(breaches)} breaches")
    return 1 if breaches or not sources else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
