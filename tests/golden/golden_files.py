# SPDX-License-Identifier: Apache-2.0
"""What the generators of golden data share: numbers to text, tables, writing and checking files. Debian: python3-mpmath."""
import pathlib
import sys

try:
    from mpmath import mp, mpf
except ImportError:
    print("python3-mpmath is not installed")
    sys.exit(77)

HERE = pathlib.Path(__file__).resolve().parent


def table(name, comments, columns, rows, text_of):
    """Name and text of a CSV file; `text_of` prints one value."""
    lines = ["# " + c for c in comments] + [",".join(columns)]
    lines += [",".join(text_of(x) for x in row) for row in rows]
    return name, "\n".join(lines) + "\n"


def write_or_check(files):
    """Writes `files`, pairs of name and text, beside the generator. With --check says whether they are what it would
    write, and exits with 1 if not."""
    check = sys.argv[1:] == ["--check"]
    bad = 0
    for name, text in files:
        path = HERE / name
        if not check:
            path.write_text(text)
            print("wrote", name, len(text.splitlines()), "lines")
        elif not path.exists() or path.read_text() != text:
            print(name, f"is not what the generator writes: run {pathlib.Path(sys.argv[0]).name} and review the difference")
            bad = 1
        else:
            print(name, "is as generated")
    sys.exit(bad)
