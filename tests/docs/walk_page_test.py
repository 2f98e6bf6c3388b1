# SPDX-License-Identifier: Apache-2.0
"""A walker that passes everything proves nothing: pages that are wrong must fail, and by their line."""
import pathlib
import subprocess
import sys
import tempfile

WALKER = pathlib.Path(__file__).with_name("walk_page.py")
RIGHT = "# A page\n\n```sh\nname=world\necho hello $name; echo bye\n```\n\n```text\nhello ...\n...\n```\n"


def walk(text):
    """What walking a page of `text` said; "" where it went well."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "bin").mkdir()
        (folder / "page.md").write_text(text)
        result = subprocess.run([sys.executable, WALKER, folder, folder / "bin", folder / "page.md"],
                                capture_output=True, text=True, check=False)
        return result.stderr if result.returncode else ""


def main():
    assert walk(RIGHT) == "", walk(RIGHT)
    wrong = {
        RIGHT.replace("hello ...", "hallo ..."): "page.md:8: the page shows",
        RIGHT.replace("...\n```", "bye bye\n```"): "page.md:8: the page shows",
        RIGHT.replace("hello ...\n...", "hello world"): "page.md:8: the page shows",
        RIGHT.replace("echo bye", "false; echo bye"): "page.md:3: a command failed",
        RIGHT.replace("echo bye", "exit 0"): "page.md:3: a command failed",
        RIGHT.replace("```sh", "```sh tested-by Nothing.Of.This.Name"): "page.md:3: there is no test",
        "# A page\n\nwithout commands\n": "page.md: no block ran",
    }
    for text, reason in wrong.items():
        assert reason in walk(text), f"{text}\nwas to fail with '{reason}', said: {walk(text)!r}"
    print(f"{len(wrong)} wrong pages failed")


if __name__ == "__main__":
    main()
