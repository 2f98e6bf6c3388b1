# SPDX-License-Identifier: Apache-2.0
"""The check of sentences finds those that are too long, by page and line, and nothing else. The table has what it says."""
import contextlib
import io
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import readability  # noqa: E402
from readability import MAX_MEAN, MAX_WORDS, sentences  # noqa: E402
from wording import count_of_terms, is_passive, terms_of  # noqa: E402

GLOSSARY = "| word | meaning |\n|---|---|\n| CL block | a record |\n| pole | a place |\n| feed, feed override | a speed |\n"


def findings(text):
    """What the check says of a page below docs, and its exit code."""
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        (root / "docs" / "below").mkdir(parents=True)
        (root / "README.md").write_text("# Short\n\nIt is short.\n")
        (root / "docs" / "below" / "page.md").write_text(text)
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            code = readability.main(root)
        return code, [line for line in out.getvalue().splitlines() if "page.md:" in line]


def row_of_page(text):
    """The row of a page in the table, without its name."""
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        (root / "docs").mkdir()
        (root / "docs" / "glossary.md").write_text(GLOSSARY)
        (root / "README.md").write_text(text)
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            readability.main(root, has_table=True)
        return next(line.split()[1:] for line in out.getvalue().splitlines() if line.startswith("README.md "))


def counted(text):
    return [(line, len(words)) for line, words in sentences(text)]


def main():
    assert counted("# Not this\n\nOne two. Three\nfour five! (Six) seven?\n") == [(3, 2), (3, 3), (4, 2)]
    assert counted("`a b\nc d` is code. `e f` too.\n") == [(1, 3), (2, 2)]
    assert counted("One, e.g. Two, at 3.5 mm.\n") == [(1, 6)]
    assert counted("A list:\n\n* one two\n  three\n* four [five](six.md#seven)\n10. eight\n") == [
        (1, 2), (3, 3), (5, 2), (6, 1)]
    assert counted("1. One.\n\n       code code\n\n   Two three.\n") == [(1, 1), (5, 2)]
    assert counted("```sh\na b\n```\n\n    c d\n\n| e f |\n\n$$\ng h\n$$\n\n<!-- i\nj -->\n\nIt $= 1 + 2$ is.\n") == [
        (16, 3)]
    long = "Word" + " word" * (MAX_WORDS - 1)
    short = "\n\n" + "It is. " * MAX_WORDS
    assert findings(f"# Page\n\n{long}.{short}\n") == (0, [])
    code, found = findings(f"# Page\n\nIt is.\n{long} too\nmany.{short}\n")
    assert code == 1 and len(found) == 1 and found[0].startswith(f"docs/below/page.md:4: {MAX_WORDS + 2} words"), found
    code, found = findings("# Page\n\n" + ("Word" + " word" * MAX_MEAN + ".\n") * 3)
    assert code == 1 and len(found) == 1 and found[0].startswith("docs/below/page.md:1: "), found

    for sentence in ("The queue is emptied.", "It was not yet read by a drive.", "Blocks have been cut.",
                     "It is then slowly driven."):
        assert is_passive(sentence.split()), sentence
    for sentence in ("The cycle empties it.", "It is the feed.", "It has moved.", "The tool is there and moved.", "It is red."):
        assert not is_passive(sentence.split()), sentence
    terms = terms_of(GLOSSARY)
    assert sorted(terms) == [("cl", "block"), ("feed",), ("feed", "override"), ("pole",)], terms
    for sentence, count in (("At the pole.", 1), ("CL blocks, and the feed override!", 4), ("Feeds feed poles.", 3),
                            ("A block.", 0)):
        assert count_of_terms(sentence.split(), terms) == count, sentence
    assert row_of_page("# Page\n\nThe pole is passed. It goes on there.\n") == ["2", "4.0", "4", "50", "12"]


if __name__ == "__main__":
    main()
