# SPDX-License-Identifier: Apache-2.0
"""The check of figures finds those that nothing named prints, and tests that do not exist, and nothing else."""
import contextlib
import io
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import figures  # noqa: E402

RECIPE = "meridian_test(time_test unit SOURCES time_test.cpp)\n"
RECIPE += "add_test(NAME Machine.${name}.RunsItsPattern COMMAND x)\nadd_test(NAME ${name} COMMAND x)\n"
TESTS = "TEST(Time, IsShort) {}\nTEST_F(Time, IsTheSame) {}\nTEST_P(Drawn, KeepsLimits) {}\n"
PRINT = ("Time.IsShort", "Time.*", "Time.IsTh...", "Time.IsSh…", "Every/Drawn.KeepsLimits/3", "Machine.lai.RunsItsPattern",
         "time_test", "time_test.cpp", "build/release/bin/time_test --gtest_filter='*'", "tests/time_test.cpp", "deploy/demo",
         "time deploy/demo", "meridian simulate PART", "MERIDIAN_N=5 meridian bench --write OUT", "ctest -L bench")
TABLE = "| what | {} |\n|---|---|\n| a cycle | 3.5 |\n"


def findings(text):
    """The lines of a page with a finding, and the exit code."""
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        for folder in ("docs", "tests", "deploy"):
            (root / folder).mkdir()
        (root / "tests" / "CMakeLists.txt").write_text(RECIPE)
        (root / "tests" / "time_test.cpp").write_text(TESTS)
        (root / "deploy" / "demo").touch(0o755)
        (root / "deploy" / "table.toml").touch(0o644)
        (root / "README.md").write_text("# Quiet\n\nNothing is measured.\n")
        (root / "docs" / "page.md").write_text(text)
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            code = figures.main(root)
        return code, [int(line.split(":")[1]) for line in out.getvalue().splitlines() if line.startswith("docs/page.md:")]


def expect_fine(*texts):
    for text in texts:
        assert findings(text) == (0, []), text


def expect_found(text, *lines):
    assert findings(text) == (1, list(lines)), (text, findings(text))


def main():
    # What is no measured figure: a setting, a budget, a number without a unit, a measurement without a number.
    expect_fine("A hold lasts 3 s at most.", "It took two tries.", "The median decides.", "It takes the block.",
                "```sh\nmeasured 3 s\n```\n", "<!-- measured 3 s -->\n")
    for figure in ("It took 3.5 s.", "It takes some 3 ms.", "The p99 is 12 µs.", "The median of 20 runs is 5 %.",
                   "Measured: 4 MiB.", "At worst\n5 to 7 cycles.", "On average 1 000 instructions."):
        expect_found(f"# Page\n\n{figure}\n", 3)
        for name in PRINT:
            expect_fine(f"# Page\n\n{figure}\nSee `{name}`.\n")
        for name in ("deploy/table.toml", "deploy/none", "meridian", "cycle_time", "other_test"):
            expect_found(f"# Page\n\n{figure}\nSee `{name}`.\n", 3)
    # What is named elsewhere on the page does not count, what introduces a list or table and the commands beside do.
    expect_found("See `Time.*`.\n\nIt took 3 s.\n", 3)
    expect_found("- `Time.*`: so\n- it took 3 s\n", 2)
    expect_fine("As `Time.*` prints:\n\n- so\n- it took 3 s\n", "```sh\nmeridian simulate PART\n```\nIt took 3 s.\n",
                "It took 3 s:\n\n```sh\nmeridian simulate PART\n```\n", "So `Time.*` says:\n\n" + TABLE.format("p99, s"))
    for head in ("p99, s", "measured", "result", "figure"):
        expect_found(TABLE.format(head), 3)
    expect_fine(TABLE.format("default"))
    # Where a table has a column for the name, the row has it.
    expect_found("See `Time.*`.\n\n| what | result | test |\n|---|---|---|\n| a | 3 s | `Time.*` |\n| b | 4 s | the same |\n", 6)
    # A test that does not exist prints nothing, whatever it is named for.
    expect_found("# Page\n\n`Time.IsLong` is a test.\n", 3)
    expect_found("```sh\nmeridian\n```\n\nSee `one` and `Time.IsLong`.\n", 5)
    expect_found("It took 3 s (`Time.IsLo...`).\n", 1, 1)
    expect_found("It is so (`Times.*`).\n", 1)


if __name__ == "__main__":
    main()
