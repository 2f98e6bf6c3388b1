# SPDX-License-Identifier: Apache-2.0
"""Walks a tutorial as its reader would: every `sh` block in one shell, one behind the other.

    walk_page.py SOURCE BINARIES PAGE

The shell stands in an empty folder that looks like a clone which was built: `deploy` and `docs` of
SOURCE, and build/release/bin, which is BINARIES. A `text` block says what the block before it
printed. Its lines must be printed in this order, one behind the other; a line of `...` stands for
any lines, and `...` in a line for anything in it. A block `sh tested-by NAME` is not run here: the
test NAME runs it (CTest is asked whether there is one).

The test fails where a command fails, where an output is another one, and where a page has no block.
"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

FENCE = re.compile(r"^```(?P<info>.+)\n(?P<body>(?:.*\n)*?)```$", re.M)
LAST_WORD = "walk: the block ended"


def matches(wanted, printed):
    """Whether the lines `printed` begin with the lines `wanted`; `...` as above."""
    if not wanted:
        return not printed
    if wanted[0].strip() == "...":
        return any(matches(wanted[1:], printed[n:]) for n in range(len(printed) + 1))
    if not printed:
        return False
    pattern = ".*".join(re.escape(part) for part in wanted[0].rstrip().split("..."))
    return re.fullmatch(pattern, printed[0].rstrip()) is not None and matches(wanted[1:], printed[1:])


class Shell:
    """A reader's shell. What it starts in the background ends with it."""

    def __init__(self, folder):
        self.folder = folder
        environment = {**os.environ, "MERIDIAN_DOMAIN": str(20 + os.getpid() % 40), "TERM": "dumb"}
        self.process = subprocess.Popen(["bash"], cwd=folder, stdin=subprocess.PIPE, text=True,
                                        stdout=subprocess.PIPE, env=environment,
                                        start_new_session=True)
        self.process.stdin.write("set -e -o pipefail\n")

    def run(self, number, block):
        """What a block printed; None where it failed."""
        script, output = (self.folder / f".{number}.{kind}" for kind in ("sh", "out"))
        script.write_text(block)
        self.process.stdin.write(f"source {script} >{output} 2>&1\necho '{LAST_WORD}'\n")
        self.process.stdin.flush()
        said = self.process.stdout.readline().strip()
        return output.read_text(errors="replace"), said == LAST_WORD

    def end(self):
        try:
            os.killpg(self.process.pid, signal.SIGTERM)
        except ProcessLookupError:
            pass
        self.process.wait()


def is_test(binaries, name):
    listed = subprocess.run(["ctest", "--test-dir", binaries.parent, "-N", "-R", f"^{re.escape(name)}$"],
                            capture_output=True, text=True, check=False).stdout
    return f": {name}\n" in listed


def walk(binaries, page, folder):
    shell = Shell(folder)
    text = page.read_text(encoding="utf-8")
    printed, count = None, 0
    try:
        for fence in FENCE.finditer(text):
            line = text.count("\n", 0, fence.start()) + 1
            words = fence["info"].split()
            if words[:2] == ["sh", "tested-by"]:
                if not is_test(binaries, words[2]):
                    return f"{page.name}:{line}: there is no test {words[2]}"
                printed = None
            elif words == ["sh"]:
                count += 1
                printed, went_well = shell.run(count, fence["body"])
                if not went_well:
                    return f"{page.name}:{line}: a command failed:\n{fence['body']}\nIt said:\n{printed}"
            elif words == ["text"] and printed is not None:
                if not matches(fence["body"].splitlines(), printed.splitlines()):
                    return (f"{page.name}:{line}: the page shows\n{fence['body']}\nbut the commands "
                            f"printed\n{printed}")
                printed = None
    finally:
        shell.end()
    print(f"{page.name}: {count} blocks ran")
    return None if count else f"{page.name}: no block ran"


def main():
    source, binaries, page = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    with tempfile.TemporaryDirectory(prefix="meridian-page-") as name:
        folder = pathlib.Path(name)
        (folder / "build").mkdir()
        (folder / "build" / "release").symlink_to(binaries.parent)
        for part in ("deploy", "docs"):
            (folder / part).symlink_to(source / part)
        fault = walk(binaries, page, folder)
    if fault:
        sys.exit(fault)


if __name__ == "__main__":
    main()
