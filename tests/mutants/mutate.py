# SPDX-License-Identifier: Apache-2.0
"""Where a C++ source can be changed so that it means something else, and how.

The source is formatted as the project formats it: binary operators have spaces around them, templates
have none. Comments, strings, preprocessor lines and lines that say no code at run time are left alone.
"""
import dataclasses
import re

QUIET_LINE = re.compile(r"^\s*(#|using |template|namespace |static_assert|concept |requires |friend |explicit |\[\[nodiscard\]\].*;$"
                        r"|struct |class |enum |public:|private:)")
DEFAULT_VALUE = re.compile(r"^\s+(?:static |constexpr |std::)*[\w:<>, ]+ \w+ = -?[\w.:]+(?:, \w+ = -?[\w.:]+)*;\s*$")
DECLARATION = re.compile(r"^\s*(return|const|auto|double|int|bool|using|static|constexpr|case|else|for|if|while|do|struct|typename)\b")
STATEMENT = re.compile(r"^(\s*)((?:[\w.\[\]:*]|->|\(\*)+(?:\([^()]*\))?(?:\[[^\]]*\])* (?:[-+*/|&]?=) .*;|[\w.:]+(?:->[\w.]+)*\(.*\);|continue;|break;)\s*$")
SWAPS = [("sign", " + ", " - "), ("sign", " += ", " -= "), ("factor", " * ", " / "), ("factor", " *= ", " /= "),
         ("equality", " == ", " != "), ("logic", " && ", " || "), ("extreme", "std::min(", "std::max("),
         ("extreme", ".min(", ".max("), ("extreme", "minCoeff(", "maxCoeff("), ("flag", "true", "false")]
TURNED = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}
LOOSENED = {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}


@dataclasses.dataclass(frozen=True)
class Mutant:
    """`text` in the stead of the characters [begin, end) of a source."""
    begin: int
    end: int
    text: str
    kind: str

    def of(self, source):
        return source[:self.begin] + self.text + source[self.end:]

    def line_in(self, source):
        return source.count("\n", 0, self.begin) + 1

    def words(self, source):
        """What is there and what comes in its stead, each in one line."""
        return f"`{' '.join(source[self.begin:self.end].split())}` -> `{' '.join(self.text.split())}`"


def code_of(source):
    """`source` with blanks where nothing runs: as many characters, the same lines."""
    def blank(found):
        return re.sub(r"[^\n]", " ", found.group(0))
    code = re.sub(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])'", blank, source, flags=re.S)
    return "\n".join(" " * len(line) if QUIET_LINE.match(line) else line for line in code.split("\n"))


def closing(code, at):
    """Index of the bracket that closes the one at `at`; -1: none does."""
    depth = 0
    for k in range(at, len(code)):
        depth += (code[k] in "([{") - (code[k] in ")]}")
        if depth == 0:
            return k
    return -1


def end_of_term(code, begin, ends):
    """First index from `begin` on at which, outside of brackets, one of `ends` stands or a bracket closes."""
    k = begin
    while k < len(code):
        if code[k] in "([{":
            k = closing(code, k)
            if k < 0:
                return -1
        elif code[k] in ")]}" or any(code.startswith(end, k) for end in ends):
            return k
        k += 1
    return -1


def swaps(code):
    for kind, one, other in SWAPS:
        for old, new in ((one, other), (other, one)):
            pattern = rf"\b{old}\b" if kind == "flag" else re.escape(old)
            for found in re.finditer(pattern, code):
                yield Mutant(found.start(), found.end(), new, kind)


def comparisons(code):
    """The bound of a loop is moved by one, every other comparison turned round: moving that only matters to
    a number that lies on it."""
    for found in re.finditer(r" (<|<=|>|>=) ", code):
        line = code[code.rfind("\n", 0, found.start()) + 1:found.start()]
        is_loop = re.search(r"\b(for|while) \(", line) is not None
        kind = "bound" if is_loop else "comparison"
        yield Mutant(found.start(1), found.end(1), (LOOSENED if is_loop else TURNED)[found.group(1)], kind)


def branches(code):
    """a ? b : c becomes a ? c : b."""
    for found in re.finditer(r"\s\? ", code):
        middle = end_of_term(code, found.end(), (" : ", "\n"))
        while 0 <= middle < len(code) and code[middle] == "\n":
            at = re.compile(r"\s*: ").match(code, middle)
            if at:
                break
            middle = end_of_term(code, middle + 1, (" : ", "\n"))
        colon = re.compile(r"\s*: ").match(code, middle) if middle >= 0 else None
        end = end_of_term(code, colon.end(), (";", ",")) if colon else -1
        if end < 0:
            continue
        one, other = code[found.end():middle].strip(), code[colon.end():end].strip()
        if one and other and one != other and "?" not in other:
            yield Mutant(found.end(), end, f"({other}) : ({one})", "branch")


def conditions(code):
    for found in re.finditer(r"\b(if|while) \(", code):
        end = closing(code, found.end() - 1)
        inside = code[found.end():end]
        if end > 0 and ";" not in inside:
            yield Mutant(found.end(), end, f"!({inside})", "condition")


def constants(code, is_header):
    for found in re.finditer(r"(?<=[\s(\[{-])(\d+\.\d*(?:e-?\d+)?|\d+e-?\d+|\d+)(?=[\s)\],;}])", code):
        line_begin = code.rfind("\n", 0, found.start()) + 1
        line = code[line_begin:code.find("\n", found.start())]
        if is_header and DEFAULT_VALUE.match(line) and "constexpr" not in line:
            continue  # what is set before it is read
        text = found.group(1)
        if text in ("0", "1"):
            yield Mutant(found.start(), found.end(), "1" if text == "0" else "0", "constant")
        elif text.isdigit():
            yield Mutant(found.start(), found.end(), str(int(text) // 2), "constant")
        elif float(text) > 1e-9:  # below: a floor that keeps a division finite
            yield Mutant(found.start(), found.end(), f"({text} * 2)", "constant")


def statements(code):
    begin, before = 0, ""
    for line in code.split("\n"):
        found = STATEMENT.match(line)
        if found and not DECLARATION.match(line) and re.search(r"[;{})]\s*$|else\s*$", before):
            yield Mutant(begin + found.end(1), begin + len(line.rstrip()), ";", "statement")
        begin += len(line) + 1
        before = line if line.strip() else before


def mutants_of(source, is_header=False):
    """Every mutant of `source`, in the order of the text."""
    code = code_of(source)
    found = [*swaps(code), *comparisons(code), *branches(code), *conditions(code), *constants(code, is_header),
             *statements(code)]
    return sorted(set(found), key=lambda mutant: (mutant.begin, mutant.end, mutant.kind, mutant.text))
