#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The seeding of faults, tried on a piece of which it is known what its tests catch."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import mutate

HERE = pathlib.Path(__file__).resolve().parent
PIECE = """#include "service/core/toy/limited.hpp"

// 3 + 4 in a comment is no code, nor is "5 < 6" in a string.
int limited(int x) {
  if (x > 10) return 10;
  return x + 1;
}
"""
TEST = """#include "service/core/toy/limited.hpp"

#include <gtest/gtest.h>

TEST(Limited, %s) { %s }
"""
WEAK = "EXPECT_EQ(limited(5), 6);"
STRONG = WEAK + " EXPECT_EQ(limited(11), 10); EXPECT_EQ(limited(8), 9);"


def described(source):
    return [(mutant.kind, mutant.words(source)) for mutant in mutate.mutants_of(source)]


class Mutants(unittest.TestCase):
    def test_lie_in_code_alone(self):
        self.assertEqual(described(PIECE), [
            ("condition", "`x > 10` -> `!(x > 10)`"), ("comparison", "`>` -> `<=`"), ("constant", "`10` -> `5`"),
            ("constant", "`10` -> `5`"), ("sign", "`+` -> `-`"), ("constant", "`1` -> `0`")])

    def test_swap_branches_and_move_bounds_of_loops(self):
        source = "void f() {\n  for (int i = 2; i < n; ++i) b = c ? p[i] : q(1, 2);\n}\n"
        found = described(source)
        self.assertIn(("bound", "`<` -> `<=`"), found)
        self.assertIn(("branch", "`p[i] : q(1, 2)` -> `(q(1, 2)) : (p[i])`"), found)

    def test_drop_statements_but_no_declarations(self):
        source = "void f() {\n  int a = 2;\n  a_ += 3.5;\n  g(a);\n  return h(a);\n}\n"
        dropped = [words for kind, words in described(source) if kind == "statement"]
        self.assertEqual(dropped, ["`a_ += 3.5;` -> `;`", "`g(a);` -> `;`"])
        self.assertIn(("constant", "`3.5` -> `(3.5 * 2)`"), described(source))

    def test_turn_extremes_and_logic_round(self):
        source = "bool f() {\n  return std::min(a, b) == c && is_there();\n}\n"
        self.assertEqual([kind for kind, _ in described(source)], ["extreme", "equality", "logic"])


class Campaign(unittest.TestCase):
    """Every mutant of the piece above is seeded: the strong test catches all six, the weak one four."""

    def run_on(self, folder, body):
        root = folder / "root"
        for path, text in (("service/core/toy/limited.cpp", PIECE),
                           ("service/core/toy/limited.hpp", "#pragma once\nint limited(int x);\n"),
                           ("tests/unit/toy/limited_test.cpp", TEST % ("IsAsItIs", body))):
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text)
        table = folder / "pieces.txt"
        table.write_text("# piece and tests\nservice/core/toy/limited tests/unit/toy/limited_test.cpp\n")
        before = {path: path.read_bytes() for path in root.rglob("*") if path.is_file()}
        done = subprocess.run([sys.executable, str(HERE / "seed_mutants.py"), "--root", str(root), "--table", str(table),
                               "--work", str(folder / "work"), "--survivors", "--plain-headers"], capture_output=True, text=True, check=False)
        self.assertEqual({path: path.read_bytes() for path in root.rglob("*") if path.is_file()}, before)
        return done.returncode, done.stdout + done.stderr

    def test_counts_what_is_caught(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            code, words = self.run_on(folder, STRONG)
            self.assertEqual(code, 0, words)
            self.assertRegex(words, r"service/core/toy/limited +6 +6 +100 %")
            code, words = self.run_on(folder, WEAK)
            self.assertEqual(code, 1, words)
            self.assertRegex(words, r"service/core/toy/limited +4 +6 +67 %")
            self.assertEqual(words.count("limited.cpp:5: constant: `10` -> `5`"), 2, words)
            self.assertIn("1 of 1 pieces under 90 %", words)
            code, words = self.run_on(folder, "EXPECT_EQ(limited(5), 7);")
            self.assertNotEqual(code, 0)
            self.assertIn("its tests fail without a mutant", words)


if __name__ == "__main__":
    unittest.main()
