# SPDX-License-Identifier: Apache-2.0
"""Checks every link of the pages: the file is there, and so is the heading that an anchor names.

    check_links.py SOURCE

Looks at README.md and at every page below docs. Links to the web are not followed. A heading's anchor
is what GitHub and MkDocs make of it: lower case, blanks to hyphens, no other punctuation.
"""
import pathlib
import re
import sys

LINK = re.compile(r"(?<!!)\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^)\s]+)\)|!\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"^```.*?^```$|`[^`\n]*`", re.M | re.S)


def anchors_of(text):
    """The anchors of the headings of a page, in which repeated ones are numbered."""
    seen, anchors = {}, set()
    for heading in re.findall(r"^#{1,6} +(.+?) *#*$", re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S), re.M):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        slug = re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        anchors.add(slug if count == 0 else f"{slug}-{count}")
    return anchors


def broken_links(root, page):
    """What is wrong with the links of a page: (line, link, reason)."""
    text = page.read_text()
    plain = CODE.sub(lambda code: re.sub(r"[^\n]", " ", code.group()), text)
    for match in LINK.finditer(plain):
        link = match.group(1) or match.group(2)
        if re.match(r"[a-z]+:", link):
            continue
        line = plain.count("\n", 0, match.start()) + 1
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        if not target.exists() or root not in [target, *target.parents]:
            yield line, link, "there is no such file"
        elif anchor and target.suffix == ".md" and anchor not in anchors_of(target.read_text()):
            yield line, link, f"{target.name} has no such heading"


def main(root):
    pages = [root / "README.md", *sorted((root / "docs").rglob("*.md"))]
    findings = [f"{page.relative_to(root)}:{line}: {link}: {reason}"
                for page in pages for line, link, reason in broken_links(root, page)]
    print("\n".join(findings) or f"{len(pages)} pages, every link leads somewhere")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
