# SPDX-License-Identifier: Apache-2.0
"""A walker that passes everything proves nothing: pages that are wrong must fail, and by their line."""
import pathlib
import subprocess
import sys
import tempfile

WALKER = pathlib.Path(__file__).with_name("walk_page.py")
RIGHT = "# A page\n\n```sh\nname=world\necho hello $name; echo bye\n```\n\n```text\nhello ...\n...\n```\n"
FILE = "# A page\n\n<!-- walk: file a/b.toml -->\n```toml\nx = 1\n```\n\n```sh\ncat a/b.toml\n```\n\n```text\nx = 1\n```\n"
BESIDE = ("<!-- walk: beside -->\n```sh\nsleep 0.2; echo ready; sleep 60\n```\n\n```text\nready\n```\n"
          "<!-- walk: run\necho hidden\n-->\n```text\nhidden\n```\n")
ENDED = "<!-- walk: beside -->\n```sh\necho ready; sleep 60\n```\n\n<!-- walk: end -->\n"
FAILS = "<!-- walk: fails 3 -->\n```sh\necho no; exit 3; echo on\n```\n```text\nno\n```\n"
PART = "<!-- walk: part-of docs/a.cpp -->\n```cpp\nint b;\n  int c;\n```\n"
INSTALLED = "```sh\necho x >/etc/meridian/y; ls /etc/meridian/y\n```\n```text\n/etc/meridian/y\n```\n"
FORMULA = "A page:\n\n    a = b\n\n<!-- walk: drawing -->\n```\n--->\n```\n"


def walk(text):
    """What walking a page of `text` said; "" where it went well."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "bin").mkdir()
        (folder / "docs").mkdir()
        (folder / "docs" / "a.cpp").write_text("int a;\n  int b;\n  int c;\n")
        (folder / "page.md").write_text(text)
        result = subprocess.run([sys.executable, WALKER, folder, folder / "bin", folder / "page.md"],
                                capture_output=True, text=True, check=False)
        return result.stderr if result.returncode else ""


def main():
    for text in (RIGHT, FILE, BESIDE, ENDED, FAILS, PART, INSTALLED, FORMULA):
        assert walk(text) == "", f"{text}\nwas to be right, said: {walk(text)}"
    wrong = [
        (RIGHT.replace("hello ...", "hallo ..."), "page.md:8: the page shows"),
        (RIGHT.replace("...\n```", "bye bye\n```"), "page.md:8: the page shows"),
        (RIGHT.replace("hello ...\n...", "hello world"), "page.md:8: the page shows"),
        (RIGHT.replace("echo bye", "false; echo bye"), "page.md:3: a command failed"),
        (RIGHT.replace("echo bye", "exit 0"), "page.md:3: a command failed"),
        (FILE.replace("x = 1", "x = 2", 1), "page.md:12: the page shows"),
        (BESIDE.replace("sleep 60", "true"), "page.md: commands that were to run beside the page ended"),
        (BESIDE.replace("echo hidden", "echo shown"), "page.md:12: the page shows"),
        (ENDED.replace("beside", "run"), "page.md:1: no use of a block"),
        (ENDED + "<!-- walk: end -->\n", "page.md:7: nothing runs beside the page"),
        (FAILS.replace("exit 3", "exit 2"), "page.md:1: the exit code is 2"),
        (PART.replace("int c", "int d"), "page.md:1: these lines are not in docs/a.cpp"),
        (PART.replace("a.cpp", "b.cpp"), "page.md:1: these lines are not in docs/b.cpp"),
        ("\n```text\nprinted\n```\n", "page.md:2: the block before it ran nothing"),
        ("\n```\nmeridian --help\n```\n", "page.md:2: a block that is neither run nor says why not"),
        ("\n```toml\nx = 1\n```\n", "page.md:2: a block that is neither run nor says why not"),
        ("\n<!-- walk: words -->\n```sh\nx\n```\n", "page.md:2: no use of a block"),
        ("\n<!-- walk: skip it -->\n```sh\nx\n```\n", "page.md:2: no use of a block"),
        ("\n<!-- walk: words needs root -->\n\n```sh\nx\n```\n", "page.md:2: a fence or a comment that belongs to no"),
        ("1. List\n\n   ```sh\n   x\n   ```\n", "page.md:3: a fence or a comment that belongs to no block"),
        ("A page:\n\n    meridian --help\n", "page.md:3: an indented command"),
        ("# A page\n\nwithout commands\n", "page.md: no block ran"),
    ]
    for text, reason in wrong:
        assert reason in walk(text), f"{text}\nwas to fail with '{reason}', said: {walk(text)!r}"
    print(f"{len(wrong)} wrong pages failed")


if __name__ == "__main__":
    main()
