# SPDX-License-Identifier: Apache-2.0
"""Walks a page as its reader would: its commands in one shell, one after the other.

    walk_page.py SOURCE BINARIES PAGE [--beside-others]

pages.py says what the blocks of a page are. The shell stands in an empty folder that looks like a
clone which was built: folders of SOURCE, and build/release/bin, which is BINARIES. Commands that name
folders of the installed package (INSTALLED) have them there too. A page that is no tutorial begins
where the first tutorial ends: the programs are found, and DDS stays on this host. With --beside-others service and
drives go before the planners of other tests' services.

A `text` block says what the block before it printed. Its lines must be printed in this order, one
behind the other; a line of `...` stands for any lines, and `...` in a line for anything in it.

The test fails where a command fails, where an output is another one, where commands that run beside
the page have ended before it, and where a page has no block.
"""
import pathlib
import sys
import tempfile

import shell
from pages import RUN, blocks_of

BEFORE_PLANNERS = pathlib.Path(__file__).absolute().parent / "before_planners"
PARTS = ("bindings", "deploy", "docs", "include", "tests")
INSTALLED = {"/usr/share/meridian": "deploy", "/etc/meridian": "etc", "/var/lib/meridian": "var"}
CONFIGURATION = ("service.toml", "tools.toml", "machines", "cyclonedds-hosts.xml")  # in /etc/meridian
SET_UP = "export PATH=$PWD/build/release/bin:$PATH CYCLONEDDS_URI=file://$PWD/deploy/cyclonedds-loopback.xml\n"
PATIENCE_S = 30  # until commands beside the page have printed what it shows


def programs_before_planners(release, binaries):
    """A build folder as that of `binaries`, whose service and drives go before the planners of other services."""
    (release / "bin").mkdir(parents=True)
    for file in binaries.parent.iterdir():
        if file != binaries:
            (release / file.name).symlink_to(file)
    for file in binaries.iterdir():
        if file.name not in ("meridian", "meridiand"):
            (release / "bin" / file.name).symlink_to(file)
    for name, others in (("meridiand", ""), ("meridian", '[ "$1" = drives ] || exec {} "$@"\n')):
        program = release / "bin" / name
        program.write_text(f'#!/bin/sh\n{others.format(binaries / name)}exec {BEFORE_PLANNERS} {binaries / name} "$@"\n')
        program.chmod(0o755)


def prepare(folder, source, binaries, is_beside_others):
    if is_beside_others:
        programs_before_planners(folder / "build" / "release", binaries)
    else:
        (folder / "build").mkdir()
        (folder / "build" / "release").symlink_to(binaries.parent)
    for part in PARTS:
        if (source / part).exists():
            (folder / part).symlink_to(source / part)
    for name in ("etc", "var"):
        (folder / name).mkdir()
    for name in CONFIGURATION:
        (folder / "etc" / name).symlink_to(source / "deploy" / name)


def is_part_of(body, file):
    """Whether the lines of `body` stand in `file` one after the other, however they are indented."""
    def plain(text):
        return "\n".join(line.strip() for line in text.splitlines())
    return file.is_file() and f"\n{plain(body)}\n" in f"\n{plain(file.read_text())}\n"


class Walk:
    """What is done with the blocks of a page, each of which returns what is wrong with it, or None."""

    def __init__(self, source, folder, is_tutorial):
        self.source, self.folder = source, folder
        self.shell = shell.Shell(folder)
        self.printed = None  # a function: what the block before printed until now
        self.patience_s = 0  # until it has printed what the page shows
        self.uses = {"run": self.run, "fails": self.fails, "beside": self.beside, "output": self.output,
                     "end": self.end, "file": self.file, "part-of": self.part_of}
        if not is_tutorial:
            self.shell.run(SET_UP)

    def here(self, text):
        for installed, part in INSTALLED.items():
            text = text.replace(installed, str(self.folder / part))
        return text

    def installed(self, text):
        for installed, part in INSTALLED.items():
            text = text.replace(str(self.folder / part), installed)
        return text

    def take(self, block):
        if block.use != "output":
            self.printed = None
        return self.uses[block.use](block) if block.use in self.uses else None

    def prints_to(self, output, patience_s=0):
        self.printed = lambda: self.installed(output.read_text(errors="replace"))
        self.patience_s = patience_s

    def run(self, block):
        output, went_well = self.shell.run(self.here(block.body))
        self.prints_to(output)
        return None if went_well else f"a command failed, or took too long:\n{block.body}\nIt said:\n{self.printed()}"

    def fails(self, block):
        output, code = self.shell.run_apart(self.here(block.body))
        self.prints_to(output)
        is_wanted = code == int(block.value)
        return None if is_wanted else f"the exit code is {code}:\n{block.body}\nIt said:\n{self.printed()}"

    def beside(self, block):
        self.prints_to(self.shell.start(self.here(block.body)), PATIENCE_S)

    def end(self, _):
        return None if self.shell.end_last(PATIENCE_S) else "nothing runs beside the page, or it printed nothing"

    def output(self, block):
        if self.printed is None:
            return "the block before it ran nothing"
        wanted = block.body.splitlines()
        if shell.eventually(lambda: shell.matches(wanted, self.printed().splitlines()), self.patience_s):
            return None
        return f"the page shows\n{block.body}\nbut the commands printed\n{self.printed()}"

    def file(self, block):
        path = self.folder / block.value
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(block.body)

    def part_of(self, block):
        return None if is_part_of(block.body, self.source / block.value) else f"these lines are not in {block.value}"


def walk(source, binaries, page, folder, is_beside_others):
    try:
        blocks = blocks_of(page.read_text(encoding="utf-8"))
    except ValueError as fault:
        return f"{page.name}:{fault}"
    prepare(folder, source, binaries, is_beside_others)
    steps = Walk(source, folder, page.parent.name == "tutorials")
    try:
        for block in blocks:
            if fault := steps.take(block):
                return f"{page.name}:{block.line}: {fault}"
        if ended := steps.shell.ended():
            return f"{page.name}: commands that were to run beside the page ended, and said:\n{ended}"
    finally:
        steps.shell.end()
    count = sum(block.use in RUN for block in blocks)
    print(f"{page.name}: {count} blocks ran")
    return None if blocks else f"{page.name}: no block ran"


def main():
    source, binaries, page = (pathlib.Path(word).absolute() for word in sys.argv[1:4])
    with tempfile.TemporaryDirectory(prefix="meridian-page-") as name:
        if fault := walk(source, binaries, page, pathlib.Path(name), "--beside-others" in sys.argv):
            sys.exit(fault)


if __name__ == "__main__":
    main()
