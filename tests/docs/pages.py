# SPDX-License-Identifier: Apache-2.0
"""The blocks of code of a page, and what each is for.

What a block is for follows from its language, or from a comment in the line before it, which a reader
does not see:

    ```sh                            commands: they are run
    ```text                          what the block before printed, compared line by line
    <!-- walk: fails 1 -->           commands that end with this exit code
    <!-- walk: beside -->            commands that run on beside what follows, such as a service
    <!-- walk: file NAME -->         a file that is written for the commands
    <!-- walk: part-of FILE -->      lines of FILE, which CTest builds and runs
    <!-- walk: tested-by NAME -->    the test NAME runs it
    <!-- walk: words REASON -->      not run for this reason: its programs and options exist
    <!-- walk: drawing -->           a drawing, a formula, a pattern
    <!-- walk: run                   commands that the page does not show
    COMMANDS
    -->
    <!-- walk: end -->               the last of the commands that run beside is ended, once it has printed something

A block of indented lines is a formula or a drawing.
"""
import dataclasses
import re

BLOCK = re.compile(r"(?:^<!-- walk: (?P<use>[^\n]+) -->\n(?:^<!-- \w+: begin -->\n)?)?^```(?P<language>[^\n]*)\n(?P<body>(?:[^\n]*\n)*?)```$"
                   r"|^<!-- walk: run\n(?P<hidden>(?:[^\n]*\n)*?)-->$|^<!-- walk: (?P<end>end) -->$", re.M)
USES = {"fails", "beside", "file", "part-of", "tested-by", "words", "drawing"}
WITHOUT_VALUE = {"beside", "drawing"}
RUN = {"run", "fails", "beside"}
USE_OF_LANGUAGE = {"sh": "run", "text": "output"}
COMMAND = re.compile(r"\s*(\$ |meridian\b|meridiand\b|meridian-hal\b|\./|(deploy|tests|build)/\S|(apt|cmake|ctest|ninja|export|cd) )")


@dataclasses.dataclass
class Block:
    line: int
    use: str
    value: str
    body: str


def blocks_of(text):
    """The blocks of a page in their order. ValueError("LINE: REASON") where one has no use."""
    blocks = []
    for found in BLOCK.finditer(text):
        line = text.count("\n", 0, found.start()) + 1
        if found["hidden"] is not None:
            blocks.append(Block(line, "run", "", found["hidden"]))
            continue
        if found["end"]:
            blocks.append(Block(line, "end", "", ""))
            continue
        use, _, value = (found["use"] or USE_OF_LANGUAGE.get(found["language"], "")).partition(" ")
        if not use:
            raise ValueError(f"{line}: a block that is neither run nor says why not (tests/docs/pages.py)")
        if found["use"] and (use not in USES or (use in WITHOUT_VALUE) == bool(value)):
            raise ValueError(f"{line}: no use of a block: walk: {found['use']} (tests/docs/pages.py)")
        blocks.append(Block(line, use, value, found["body"]))
    rest = BLOCK.sub(lambda one: "\n" * one.group().count("\n"), text)
    for number, line in enumerate(rest.split("\n"), 1):
        if line.lstrip().startswith("```") or "walk:" in line:
            raise ValueError(f"{number}: a fence or a comment that belongs to no block")
        if line.startswith("    ") and COMMAND.match(line):
            raise ValueError(f"{number}: an indented command, which nothing runs: put it into a block of sh")
    return blocks
