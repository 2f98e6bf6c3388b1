# SPDX-License-Identifier: Apache-2.0
"""Checks that the pages are easy to read: no sentence is too long, and a page's sentences are short on average.

    readability.py SOURCE [--table]

Reads README.md and every page below docs. With --table it prints a row for each: its sentences, their mean and
longest length in words, how many percent of them are in the passive voice, and how many percent of the words are
terms of docs/glossary.md. Code in a sentence counts as one word. Code blocks, formulas, tables and headings are
not read. An item of a list is a sentence of its own.
"""
import pathlib
import re
import sys

from wording import count_of_terms, is_passive, terms_of

MAX_MEAN = 18  # words a sentence, over a page
MAX_WORDS = 40  # in a sentence
BLOCK = re.compile(r"\A---\n.*?^---$|^ *```.*?^ *```$|<!--.*?-->", re.M | re.S)
IMAGE = re.compile(r"!\[[^\]]*\]\([^)]*\)")
LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")
CODE = re.compile(r"(`+)(?:(?!\1|\n\n).)+\1", re.S)
FORMULA = re.compile(r"\$\$.*?\$\$", re.S)
TAG = re.compile(r"</?[a-z][^>\n]*>|\*\*?")
ITEM = re.compile(r" *(?:[*+-]|\d+\.) +")
END = re.compile(r"[.!?][)\]\"'”]*$")
BEGIN = re.compile(r"[(\[\"“]*[A-Z`\d]")
NO_END = {"e.g.", "i.e.", "etc.", "cf.", "vs."}


def paragraphs(text):
    """The paragraphs and items of lists of a page, each as its words with their lines."""
    for pattern, short in ((BLOCK, ""), (CODE, "`c`"), (FORMULA, ""), (re.compile(r"\$[^$\n]+\$"), "`c`"), (IMAGE, "")):
        text = pattern.sub(lambda one: short + "\n" * one.group().count("\n"), text)
    text = TAG.sub("", LINK.sub(r"\1", re.sub(r"^( *)\* ", r"\1- ", text, flags=re.M)))
    words, margin = [], 0
    for number, line in enumerate(text.split("\n"), 1):
        indent = len(line) - len(line.lstrip())
        item = ITEM.match(line)
        is_code = not words and indent >= margin + 4 and not item
        is_prose = not is_code and not re.match(r"\s*([#|]|$)", line)
        if item or not is_prose:
            yield words
            words = []
        if item:
            margin = len(item.group())
        elif line.strip() and indent == 0 and not words:
            margin = 0
        if is_prose:
            found = (line[margin:] if item else line.lstrip("> ")).split()
            words += [(word, number) for word in found if re.search(r"[\w`]", word)]
    yield words


def sentences(text):
    """The sentences of a page: the line that each begins in, and its words."""
    for words in paragraphs(text):
        begin = 0
        for i, (word, _) in enumerate(words, 1):
            if i == len(words) or (END.search(word) and word not in NO_END and BEGIN.match(words[i][0])):
                yield words[begin][1], [each for each, _ in words[begin:i]]
                begin = i


def row_of(name, found, terms):
    counts = [len(words) for _, words in found] or [0]
    passive = 100 * sum(is_passive(words) for _, words in found) / len(counts)
    looked_up = 100 * sum(count_of_terms(words, terms) for _, words in found) / max(1, sum(counts))
    return f"{name:46} {len(found):9}  {sum(counts) / len(counts):10.1f}  {max(counts):7}  {passive:9.0f}  {looked_up:10.0f}"


def findings_of(name, found):
    counts = [len(words) for _, words in found] or [0]
    if (mean := sum(counts) / len(counts)) > MAX_MEAN:
        yield f"{name}:1: {mean:.1f} words in a sentence on average, {MAX_MEAN} at most"
    yield from (f"{name}:{line}: {len(words)} words in a sentence, {MAX_WORDS} at most: {' '.join(words[:8])} ..."
                for line, words in found if len(words) > MAX_WORDS)


def main(root, has_table=False):
    glossary = root / "docs" / "glossary.md"
    terms = terms_of(glossary.read_text()) if glossary.exists() else []
    pages = {str(page.relative_to(root)): list(sentences(page.read_text()))
             for page in [root / "README.md", *sorted((root / "docs").rglob("*.md"))]}
    if has_table:
        print(f"{'page':46} sentences  mean words  longest  passive %  glossary %")
        print("\n".join(row_of(name, found, terms) for name, found in pages.items()))
        print(row_of("all", [one for found in pages.values() for one in found], terms))
    findings = [finding for name, found in pages.items() for finding in findings_of(name, found)]
    print("\n".join(findings or ["every page is short enough"]))
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), sys.argv[2:] == ["--table"]))
