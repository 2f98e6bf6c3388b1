# SPDX-License-Identifier: Apache-2.0
"""The check of links finds what leads nowhere, by its line, and nothing else."""
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from check_links import anchors_of, broken_links  # noqa: E402


def findings(text):
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name).resolve()
        (root / "docs").mkdir()
        (root / "docs" / "other.md").write_text("# Other page\n\n## Work frames, tools\n\n## Twice\n\n## Twice\n")
        page = root / "docs" / "page.md"
        page.write_text(text)
        return list(broken_links(root, page))


def main():
    right = ("# A page\n[a](other.md) [b](other.md#work-frames-tools) [c](#a-page) [d](other.md#twice-1)\n"
             "`[x](none.md)` <https://example.org> [e](https://example.org)\n```\n[y](none.md)\n```\n")
    assert findings(right) == [], findings(right)
    assert findings("\n[a](none.md)\n") == [(2, "none.md", "there is no such file")]
    assert findings("![a](none.png)\n") == [(1, "none.png", "there is no such file")]
    assert findings("[`a`](other.md#none)\n") == [(1, "other.md#none", "other.md has no such heading")]
    assert findings("[a](#none)\n") == [(1, "#none", "page.md has no such heading")]
    assert findings("[a](../../outside.md)\n") == [(1, "../../outside.md", "there is no such file")]
    assert anchors_of("# The `--check` [word](x.md)\n") == {"the---check-word"}


if __name__ == "__main__":
    main()
