# SPDX-License-Identifier: Apache-2.0
"""Checks that measured figures of a page name what prints them, and that the tests which pages name exist.

    figures.py SOURCE

Reads README.md and every page below docs. A paragraph, an item of a list or a row of a table has a measured figure
where it has a number with a unit and a word of measuring: measured, took, takes 3 s, median, p99, worst, on average,
of 20 runs. Every row with a number has one where the head of its table says so: median, p99, measured, figure, result.

What prints it is in code quotes or in a block of commands: a test, a program or a file of the tests, a script, or a
command of `meridian`. It stands with the figure, or in the paragraph directly before the list or table, or in the
block of commands beside the paragraph. Where a table has a column for it (test, how to repeat, by, where) it stands in
the row. The name of a test may end in *, ... or ….
"""
import dataclasses
import fnmatch
import os
import pathlib
import re
import sys

NUMBER = r"\d[\d. ]*"
UNIT = (r"(?:[nµum]?s|min|h|[nµum]?m|°|[µm]?rad|%|[kMG]i?B|seconds?|minutes?|hours?|instructions?|cycles?|calls?|\w+/s|times)"
        r"(?![\w/])")
FIGURE = re.compile(rf"(?<![\w.-]){NUMBER}(?:(?:,| to| and| of| or|;) {NUMBER})* ?{UNIT}")
STATISTIC = r"medians?|p50|p75|p90|p99|worst|on average"
VERB = rf"measured|took|lasted|counted over \d|of \d[\d ]*runs|takes? (?:some |about |only )?{NUMBER}{UNIT}"
IN_PROSE = re.compile(rf"\b(?:{VERB}|{STATISTIC})(?!\w)", re.I)
IN_ROW = re.compile(rf"\b(?:{VERB})(?!\w)", re.I)
IN_HEAD = re.compile(rf"\b(?:measured|{STATISTIC}|figures?|results?|today|value|time s|executions|states)(?!\w)", re.I)
HIDDEN = re.compile(r"\A---\n.*?^---$|<!--.*?-->", re.M | re.S)
BLOCK = re.compile(r"^ *```.*?^ *```$", re.M | re.S)
CODE = re.compile(r"`([^`]+)`")
ITEM = re.compile(r" *(?:[*+-]|\d+\.) +")
TEST = re.compile(r"[A-Z]\w*(?:[/.][\w-]+)?\.(?:\*|[A-Z]\w*)[\w*/]*(?:\.\.\.|…)?")
COMMAND = re.compile(r"(?:time )?(?:[A-Z_]+=\S+ )*"
                     r"(?:(?:build/release/bin/)?(?:meridiand?|ctest) \S|(?:python3 )?((?:deploy|tests)/\S+))")
NAMES = re.compile(r"\| *(?:test|how to repeat|by|where) *\|$")


@dataclasses.dataclass
class Piece:
    """A heading, a paragraph, an item of a list, a table or a block of code."""
    kind: str
    line: int
    text: str


def without(pattern, text):
    return pattern.sub(lambda one: "\n" * one.group().count("\n"), text)


def kind_of(line, before):
    """The kind of the piece that a line belongs to, where the line before belongs to that kind; "" for an empty line."""
    if before == "code" or line.lstrip().startswith("```"):
        return "code"
    if not line.strip() or line.lstrip().startswith(("#", "|")):
        return {"": "", "#": "heading", "|": "table"}[line.strip()[:1]]
    if ITEM.match(line):
        return "item"
    return before if before in ("item", "paragraph") else "paragraph"


def pieces_of(text):
    """The pieces of a page in their order, without what readers do not see."""
    pieces, before = [], ""
    for number, line in enumerate(without(HIDDEN, text).split("\n"), 1):
        is_fence, kind = line.lstrip().startswith("```"), kind_of(line, before)
        if kind and (kind != before or kind == "heading" or (kind == "item" and ITEM.match(line))):
            pieces.append(Piece(kind, number, ""))
        if kind and not is_fence:
            pieces[-1].text += line + "\n"
        before = "" if is_fence and before == "code" else kind
    return pieces


def commands_of(piece):
    return "".join(f"`{line}`" for line in piece.text.split("\n") if line) if piece.kind == "code" else ""


def introduction_of(before):
    """What introduces a list or a table: the paragraph before it, with blocks of commands between them and before it."""
    text = ""
    for piece in reversed(before):
        text += piece.text if piece.kind == "paragraph" else commands_of(piece)
        if piece.kind in ("heading", "paragraph"):
            break
    return text


def rows_of(table):
    head, *rows = table.text.rstrip("\n").split("\n")
    for line, row in enumerate(rows, table.line + 1):
        has_figure = re.search(r"\|[^|]*\|.*\d", row) if IN_HEAD.search(head) else IN_ROW.search(row) and FIGURE.search(row)
        yield line, row, head, has_figure


def passages_of(text):
    """Every passage with a measured figure: its line, its text, and the text that may name what prints it."""
    pieces = [Piece("heading", 0, ""), *pieces_of(text), Piece("heading", 0, "")]
    for i, piece in enumerate(pieces):
        if piece.kind == "table":
            for line, row, head, has_figure in rows_of(piece):
                if has_figure:
                    yield line, row, row if NAMES.search(head) else row + introduction_of(pieces[:i])
        elif piece.kind in ("paragraph", "item") and IN_PROSE.search(piece.text) and FIGURE.search(piece.text):
            beside = (introduction_of(pieces[:i]) if piece.kind == "item"
                      else commands_of(pieces[i - 1]) + commands_of(pieces[i + 1]))
            yield piece.line, piece.text, piece.text + beside


class Printers:
    """What prints figures: tests, programs and files of the tests, scripts, commands."""

    def __init__(self, source):
        recipes = "\n".join(file.read_text() for file in (source / "tests").rglob("CMakeLists.txt"))
        files = list((source / "tests").rglob("*.cpp"))
        self.source, self.words = source, set(re.findall(r"\w+", recipes))
        recipes = re.sub(r"\$\{\w+\}", "*", recipes)
        self.programs = set(re.findall(r"\b(?:meridian_\w+|add_executable)\((\w[\w*]*)", recipes))
        self.programs |= {name for file in files for name in (file.name, file.stem) if file.stem.endswith("_test")}
        self.tests = set(re.findall(r"add_test\(NAME (\w\S+)", recipes))
        self.tests |= {f"{suite}.{name}" for file in files for suite, name
                       in re.findall(r"^TEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)", file.read_text(), re.M)}

    def has_test(self, name):
        """Whether a test has this name. Of a test with values the name of the values is left out."""
        pattern = re.sub(r"^\w+/(?=\w+\.)|/\d+$", "", re.sub(r"(?:\.\.\.|…)$", "*", name))
        has_word = pattern.split(".")[-1] in self.words  # the part of a name that a recipe spells out
        return any(fnmatch.fnmatchcase(test, pattern) or (has_word and fnmatch.fnmatchcase(pattern, test)) for test in self.tests)

    def is_script(self, path):
        return path.is_file() and (os.access(path, os.X_OK) or path.suffix == ".py" or (self.source / "tests") in path.parents)

    def is_one(self, code):
        words = " ".join(code.split())
        if TEST.fullmatch(words):
            return self.has_test(words)
        if any(fnmatch.fnmatchcase(word.split("/")[-1], each) for word in words.split()[:3] for each in self.programs):
            return True
        found = COMMAND.match(words)
        return bool(found) and (not found[1] or self.is_script(self.source / found[1]))


def findings_of(text, printers):
    """What is wrong with a page, each by its line."""
    for line, passage, names in passages_of(text):
        if not any(printers.is_one(code) for code in CODE.findall(names)):
            yield line, f"a measured figure, and nothing that prints it: {' '.join(passage.split())[:70]} ..."
    prose = without(BLOCK, without(HIDDEN, text))
    for found in CODE.finditer(prose):
        if TEST.fullmatch(found[1]) and not printers.has_test(found[1]):
            yield prose.count("\n", 0, found.start()) + 1, f"there is no test {found[1]}"


def main(source):
    printers, pages = Printers(source), [source / "README.md", *sorted((source / "docs").rglob("*.md"))]
    texts = {page.relative_to(source): page.read_text() for page in pages}
    findings = [f"{page}:{line}: {fault}" for page, text in texts.items() for line, fault in findings_of(text, printers)]
    count = sum(len(list(passages_of(text))) for text in texts.values())
    print("\n".join(findings) or f"{count} passages with measured figures name what prints them")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
