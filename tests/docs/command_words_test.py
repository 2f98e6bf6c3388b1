# SPDX-License-Identifier: Apache-2.0
"""The check of the words of commands finds programs, options and tests that do not exist, and nothing else.

    command_words_test.py SOURCE BINARIES
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from command_words import Checker, commands_of  # noqa: E402


def main():
    checker = Checker(*map(pathlib.Path, sys.argv[1:3]))

    def faults(text):
        return [fault for _, fault in checker.faults_of_page(text)]

    def faults_of_words(commands):
        return faults(f"<!-- walk: words for a test -->\n```sh\n{commands}\n```\n")

    assert list(commands_of("A=1 x --y \\\n  z  # no --z\n{ a & } && b | c\n")) == [["x", "--y", "z"], ["a"], ["b"], ["c"]]
    right = ("meridian simulate part.apt -m m.toml --explain   # --not this\nmeridiand --best-effort &\n"
             "meridian bridge ros2 --rate 10\nFOO=bar deploy/test --full\napt install --yes x")
    assert faults_of_words(right) == [], faults_of_words(right)
    assert faults_of_words("meridian simulate part.apt --explane") == ["meridian simulate has no --explane"]
    assert faults_of_words("meridian simulate \\\n  x -q") == ["meridian simulate has no -q"]
    assert faults_of_words("meridian explain part.apt") == ["there is no meridian explain"]
    assert faults_of_words("meridian bridge ros3") == ["there is no meridian bridge ros3"]
    assert faults_of_words("true && meridiand --worst-effort") == ["meridiand has no --worst-effort"]
    assert faults_of_words("deploy/tests") == ["there is no deploy/tests"]
    assert faults_of_words("deploy/test --fuller") == ["deploy/test has no --fuller"]
    assert faults_of_words("build/release/bin/bench_nothing 5") == ["nothing builds build/release/bin/bench_nothing"]
    assert faults_of_words("ctest --test-dir build/release -R Nothing.Of.This") == ["there is no test -R Nothing.Of.This"]
    assert faults("See `meridian simulate --explane`, `--explane`.\n") == ["meridian simulate has no --explane"]
    assert faults("<!-- walk: tested-by Nothing.Of.This -->\n```sh\nx\n```\n") == ["there is no test Nothing.Of.This"]
    assert list(checker.faults_of_page("\n\n`meridiand --x`")) == [(3, "meridiand has no --x")]


if __name__ == "__main__":
    main()
