# SPDX-License-Identifier: Apache-2.0
"""LAZ to LAS and back: `vantage-convert IN OUT`, or `python -m vantage.convert IN OUT`."""

import argparse
import os
import sys
import tempfile
from pathlib import Path

PIECE = 1_000_000  # Points that are in memory at a time.


class BadInput(Exception):
    """What a person can mend: one line, exit code 2."""


def compressed(path):
    """Whether the name asks for LAZ. Raises BadInput for another ending."""
    ending = path.suffix.lower()
    if ending not in (".las", ".laz"):
        raise BadInput(f"{path}: must end in .las or .laz; vantage convert writes the other formats")
    return ending == ".laz"


def copy(source, target):
    """Writes the points of an open laspy reader to the open binary file `target`; returns how many."""
    import laspy

    points = 0
    with laspy.open(target, mode="w", header=source.header, do_compress=compressed(Path(target.name)), closefd=False) as writer:
        for piece in source.chunk_iterator(PIECE):
            writer.write_points(piece)
            points += len(piece)
    if points != source.header.point_count:
        raise BadInput(f"the file ends after {points} of {source.header.point_count} points")
    return points


def convert(source, target, force=False):
    """Writes the LAS or LAZ file `source` as `target`, told by its ending; returns the number of points. The target appears whole or not at all.

    Raises BadInput for a damaged file, another ending or an existing target without `force`; OSError.
    """
    import laspy

    source, target = Path(source), Path(target)
    compressed(source)
    ending = ".laz" if compressed(target) else ".las"
    if target.exists() and not force:
        raise BadInput(f"{target}: is there already; --force replaces it")
    with open(source, "rb") as stream:
        try:
            part = tempfile.NamedTemporaryFile(dir=target.parent, prefix=f"{target.name}.", suffix=f".part{ending}", delete=False)
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(target)) from error
        try:
            with part:
                try:
                    with laspy.open(stream, closefd=False) as reader:
                        points = copy(reader, part)
                except BadInput as error:
                    raise BadInput(f"{source}: {error}") from error
                except OSError:
                    raise
                except Exception as error:  # laspy and lazrs have no common base for what is wrong with a file.
                    raise BadInput(f"{source}: {type(error).__name__}: {error}") from error
                part.flush()
                os.fsync(part.fileno())
            mask = os.umask(0)
            os.umask(mask)
            os.chmod(part.name, 0o666 & ~mask)
            os.replace(part.name, target)
        except BaseException:
            os.unlink(part.name)
            raise
    return points


def main(arguments=None):
    """The command; returns its exit code."""
    parser = argparse.ArgumentParser(
        prog="vantage-convert",
        description="Decompresses LAZ to LAS, which vantage reads, or compresses LAS. All fields of the points, the header and the coordinate system stay.",
        epilog="Exit: 0 done, 2 bad input, 3 files.",
    )
    parser.add_argument("source", metavar="IN", help=".laz or .las")
    parser.add_argument("target", metavar="OUT", help=".las or .laz")
    parser.add_argument("--force", action="store_true", help="replace OUT")
    parser.add_argument("-q", "--quiet", action="store_true", help="print nothing")
    chosen = parser.parse_args(arguments)
    try:
        points = convert(chosen.source, chosen.target, chosen.force)
    except BadInput as error:
        return fail(2, str(error))
    except OSError as error:
        return fail(3, f"{error.filename or chosen.target}: {error.strerror or error}")
    if not chosen.quiet:
        print(f"{chosen.target}: {points:,} points")
    return 0


def fail(code, message):
    print("vantage-convert: " + " ".join(message.split()), file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(main())
