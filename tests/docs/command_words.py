# SPDX-License-Identifier: Apache-2.0
"""Checks the commands that pages name without that anything runs them: programs and options exist.

    command_words.py SOURCE BINARIES [PAGE]...

Reads README.md and every page below docs: every command of their blocks, and of the code in their prose.
An option of `meridian`, `meridiand` and `meridian-hal` is one that `--help` lists, a script of the project
is there and names its option. A page with commands that are run is one of PAGE: those that CTest walks.
"""
import functools
import pathlib
import re
import subprocess
import sys

from pages import RUN, blocks_of

WALKED = RUN | {"output", "file", "part-of"}
PROGRAMS = {"meridian", "meridiand", "meridian-hal"}
SCRIPT = re.compile(r"(deploy|tests)/[\w./-]+$")
OPTION = re.compile(r"--[a-z][a-z0-9-]*")
INLINE = re.compile(r"`([^`]+)`")


def commands_of(text):
    """The commands of a script, each as its words; without comments and assignments."""
    text = re.sub(r"\\\n", " ", text)
    text = re.sub(r"(^|\s)#.*", "", text)
    for command in re.split(r"\n|&&|\|\||[;|&{})]|(?:^|(?<=\s))\(", text):
        words = command.split()
        while words and (re.match(r"[A-Z_]+=", words[0]) or words[0] in ("$", "sudo")):
            words.pop(0)
        if words:
            yield words


class Checker:
    def __init__(self, source, binaries):
        self.source, self.binaries = source, binaries

    @functools.cache
    def help_of(self, *command):
        return subprocess.run([self.binaries / command[0], *command[1:], "--help"], capture_output=True, text=True,
                              check=True).stdout

    def fault_of_build(self, words):
        """Of programs of the build that are no commands, and of choices of tests."""
        if found := re.match(r"build/release/bin/(\w+)$", words[0]):
            is_named = found[1] in PROGRAMS or re.search(rf"[( ]{found[1]}\b", self.recipes)
            return None if is_named else f"nothing builds {words[0]}"
        if words[:2] == ["ctest", "--test-dir"]:
            chosen = [word.strip("'") for word in words[3:] if not word.startswith(("-j", "--verbose"))]
            listed = self.list_tests(*chosen)
            return None if "Total Tests: 0" not in listed else f"there is no test {' '.join(chosen)}"
        return None

    def fault_of_program(self, words):
        name = pathlib.Path(words[0]).name
        if name not in PROGRAMS or not (self.binaries / name).exists():
            return None
        text, command = self.help_of(name), [name]
        for word in words[1:]:
            if "\nSubcommands:" not in text or word.startswith("-"):
                break
            is_listed = re.search(rf"\nSubcommands:(.*\n)+  {re.escape(word)} ", text)
            command.append(word)
            if not is_listed:
                return f"there is no {' '.join(command)}"
            text = self.help_of(*command)
        known = set(OPTION.findall(text)) | set(re.findall(r"(?<![\w-])-[a-z]\b", text)) | {"--help"}
        return next((f"{' '.join(command)} has no {word}" for word in words
                     if (found := re.match(r"--?[a-z][a-z0-9-]*", word)) and found.group() not in known), None)

    def fault_of_script(self, words):
        script = self.source / words[0]
        if not SCRIPT.match(words[0]):
            return None
        if not script.exists():
            return f"there is no {words[0]}"
        if script.is_dir() or not script.stat().st_mode & 0o100:
            return None
        text = script.read_text(errors="replace")
        return next((f"{words[0]} has no {word}" for word in words[1:]
                     if (found := OPTION.match(word)) and found.group() not in OPTION.findall(text)), None)

    @functools.cache
    def list_tests(self, *chosen):
        return subprocess.run(["ctest", "--test-dir", self.binaries.parent, "-N", *chosen], capture_output=True,
                              text=True, check=False).stdout

    @functools.cached_property
    def recipes(self):
        return "".join(file.read_text() for file in self.source.rglob("CMakeLists.txt"))

    def faults_of_page(self, text):
        """What is wrong with the commands of a page, each by its line."""
        scripts = [(block.line, block.body) for block in blocks_of(text) if block.use in RUN | {"words", "tested-by"}]
        blank = re.sub(r"^```.*?^```$|<!--.*?-->", lambda one: "\n" * one.group().count("\n"), text, flags=re.M | re.S)
        scripts += [(blank.count("\n", 0, found.start()) + 1, re.sub(r"\s+", " ", found[1]))
                    for found in INLINE.finditer(blank)]
        yield from ((block.line, f"there is no test {block.value}") for block in blocks_of(text)
                    if block.use == "tested-by" and f": {block.value}\n" not in self.list_tests())
        for line, script in scripts:
            for words in commands_of(script):
                if fault := (self.fault_of_program(words) or self.fault_of_script(words)
                                or self.fault_of_build(words)):
                    yield line, fault


def main(source, binaries, walked):
    checker, findings = Checker(source, binaries), []
    pages = [source / "README.md", *sorted((source / "docs").rglob("*.md"))]
    for page in pages:
        name, text = str(page.relative_to(source)), page.read_text()
        try:
            findings += [f"{name}:{line}: {fault}" for line, fault in checker.faults_of_page(text)]
            if name not in walked and any(block.use in WALKED for block in blocks_of(text)):
                findings.append(f"{name}:1: has blocks to run, and tests/docs/CMakeLists.txt does not list it")
        except ValueError as fault:
            findings.append(f"{name}:{fault}")
    print("\n".join(findings) or f"{len(pages)} pages name programs and options that exist")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(*map(pathlib.Path, sys.argv[1:3]), sys.argv[3:]))
