#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Seeds faults into a piece of the core, one at a time, and counts those that the piece's own tests catch.

    tests/mutants/seed_mutants.py [PIECE...] [--count N] [--seed N] [--jobs N] [--survivors]

pieces.txt names the pieces, and of each the tests that are its own. A mutant is a piece with one change
(mutate.py): a sign, a bound, a branch, a condition, a constant, a statement that is dropped. One that does
not compile, or compiles to the same code, is drawn again. It is caught where a test fails or does not end.
Sources are copied to --work; the checkout is never written to. Exit code 1 where a piece is under --share.
"""
import argparse
import concurrent.futures
import dataclasses
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

import mutate

HERE = pathlib.Path(__file__).resolve().parent
FLAGS = ["-std=c++20", "-ffp-contract=off", "-w", "-D_GLIBCXX_ASSERTIONS", "-fno-PIC", "-no-pie"]
SHARED_HEADERS = ["Eigen/Core", "gtest/gtest.h", "algorithm", "array", "cmath", "functional", "map", "numbers", "optional",
                  "random", "span", "string", "variant", "vector"]
COPIED = ("include", "service/core", "tests/support", "tests/unit", "tests/property")


@dataclasses.dataclass
class Piece:
    """A header or source or both, by the path without ending, and the sources of its own tests."""
    name: str
    tests: list

    def files(self, root):
        return [path for path in (self.name + ".cpp", self.name + ".hpp") if (root / path).exists()]


@dataclasses.dataclass
class Result:
    piece: Piece
    caught: int = 0
    survivors: list = dataclasses.field(default_factory=list)

    def share(self):
        return self.caught / max(1, self.caught + len(self.survivors))


def read_pieces(path):
    pieces = []
    for line in path.read_text().splitlines():
        words = line.split("#")[0].split()
        if words:
            pieces.append(Piece(words[0], words[1:]))
    return pieces


def copy_sources(root, tree):
    """The sources of `root` as they are now; what did not change keeps its time."""
    kept = set()
    for room in COPIED:
        for source in (root / room).rglob("*.[hc]pp"):
            copied = tree / source.relative_to(root)
            kept.add(copied)
            if not copied.exists() or copied.read_bytes() != source.read_bytes():
                copied.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, copied)
    for old in tree.rglob("*.[hc]pp"):
        if old not in kept:
            old.unlink()


class Builder:
    """What is built once, by ninja, in `work`: the core as a library, the shared headers, every test."""

    def __init__(self, root, work, jobs, has_shared=True):
        self.root, self.tree, self.work, self.jobs, self.has_shared = root, work / "tree", work, jobs, has_shared
        copy_sources(root, self.tree)
        eigen = next(path for path in ("/usr/include/eigen3", "/usr/local/include/eigen3") if os.path.isdir(path))
        self.includes = [f"-I{self.tree}", f"-I{self.tree}/include", f"-I{self.tree}/tests", "-isystem", eigen]

    def prepare(self, pieces):
        shared, text = self.work / "shared.hpp", "".join(f"#include <{name}>\n" for name in SHARED_HEADERS)
        if not shared.exists() or shared.read_text() != text:
            shared.write_text(text)
        flags = " ".join(FLAGS + self.includes)
        lines = ["rule cxx", f" command = g++ {flags} $level $shared -MMD -MF $out.d -c $in -o $out", " depfile = $out.d",
                 " deps = gcc", "rule header", f" command = g++ {flags} $level -x c++-header -c $in -o $out",
                 "rule archive", " command = rm -f $out && ar rcs $out $in"]
        for level in ("O0", "O1") if self.has_shared else ():
            (self.work / level).mkdir(exist_ok=True)
            lines += [f"build {level}/shared.hpp.gch: header shared.hpp", f" level = -{level}"]
        core = self.core_sources()
        tests = sorted({test for piece in pieces for test in piece.tests})
        lines += self.objects(core, "O1") + self.objects([self.tree / test for test in tests], "O0")
        lines += ["build core.a: archive " + " ".join(str(self.object_of(source)) for source in core)]
        (self.work / "build.ninja").write_text("\n".join(lines) + "\n")
        subprocess.run(["ninja", "-C", str(self.work), f"-j{self.jobs}", "-k0", "--quiet"], check=True)

    def core_sources(self):
        """What service/core/CMakeLists.txt makes the library of; all that is there where there is none."""
        listed = self.root / "service/core/CMakeLists.txt"
        if not listed.exists():
            return sorted((self.tree / "service/core").rglob("*.cpp"))
        library = re.search(r"add_library\(meridian_core STATIC(.*?)\)", listed.read_text(), re.S)
        return [self.tree / "service/core" / name for name in library.group(1).split()]

    def object_of(self, source):
        return pathlib.Path("objects") / (str(source.relative_to(self.tree)).replace("/", "_") + ".o")

    def shared(self, level):
        return ["-include", f"{level}/shared.hpp"] if self.has_shared else []

    def objects(self, sources, level):
        lines = []
        for source in sources:
            needs = f" | {level}/shared.hpp.gch" if self.has_shared else ""
            lines += [f"build {self.object_of(source)}: cxx {source}{needs}", f" level = -{level}",
                      f" shared = {' '.join(self.shared(level))}"]
        return lines

    def compile(self, source, target, overlay):
        """Whether `source` compiles with what `overlay` holds before what the tree holds."""
        command = ["g++", *FLAGS, f"-I{overlay}", f"-I{overlay}/include", *self.includes, "-O0", *self.shared("O0"),
                   "-c", str(source), "-o", str(target)]
        return subprocess.run(command, cwd=self.work, capture_output=True, check=False).returncode == 0

    def link(self, objects, program):
        command = ["g++", *FLAGS, "-fuse-ld=gold", *map(str, objects), "core.a", "-lgtest", "-lgtest_main", "-o", str(program)]
        subprocess.run(command, cwd=self.work, check=True)


class Campaign:
    """The mutants of one piece."""

    def __init__(self, builder, piece):
        self.builder, self.piece = builder, piece
        self.folder = builder.work / "mutants" / piece.name.replace("/", "_")
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        self.test_objects = {test: builder.work / builder.object_of(builder.tree / test) for test in piece.tests}
        self.plain = {}
        self.limit_s = 60.0

    def run(self, program):
        """Whether every test passes, in time."""
        try:
            return subprocess.run([str(program), "--gtest_brief=1"], cwd=program.parent, capture_output=True, check=False,
                                  timeout=self.limit_s).returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def changed_sources(self, file):
        """What has to be compiled anew where `file` changes: itself, or what includes it."""
        if file.endswith(".cpp"):
            return [file]
        beside = file[:-4] + ".cpp"
        return self.piece.tests + ([beside] if (self.builder.tree / beside).exists() else [])

    def build(self, file, text, folder):
        """The test program of `file` with `text` in it; None where it does not compile or nothing changed."""
        overlay = folder / "overlay"
        (overlay / file).parent.mkdir(parents=True, exist_ok=True)
        (overlay / file).write_text(text)
        objects, is_other = dict(self.test_objects), False
        for number, source in enumerate(self.changed_sources(file)):
            at = overlay / source if source == file else self.builder.tree / source
            target = folder / f"{number}.o"
            if not self.builder.compile(at, target, overlay):
                return None
            objects[source] = target
            is_other = is_other or target.read_bytes() != self.plain.get((file, source))
        if not is_other:
            return None
        program = folder / "program"
        self.builder.link(objects.values(), program)
        return program

    def check_plain(self, file):
        """Without a change every test passes; how long that takes bounds the mutants."""
        folder = self.folder / ("plain" + file[-4:])
        program = self.build(file, (self.builder.tree / file).read_text(), folder)
        if program is None:
            raise SystemExit(f"{file} does not compile")
        for number, source in enumerate(self.changed_sources(file)):
            self.plain[(file, source)] = (folder / f"{number}.o").read_bytes()
        begin = time.monotonic()
        if not self.run(program):
            raise SystemExit(f"{self.piece.name}: its tests fail without a mutant: {program}")
        self.limit_s = max(10.0, 5 * (time.monotonic() - begin))

    def try_mutant(self, number, file, mutant):
        """'caught', 'survived', or None where there is nothing to run."""
        folder = self.folder / str(number)
        source = (self.builder.tree / file).read_text()
        program = self.build(file, mutant.of(source), folder)
        result = None if program is None else "survived" if self.run(program) else "caught"
        shutil.rmtree(folder)
        return result

    def draw(self, count, seed, pool):
        sites = []
        for file in self.piece.files(self.builder.tree):
            source = (self.builder.tree / file).read_text()
            found = mutate.mutants_of(source, file.endswith(".hpp"))
            if found:
                self.check_plain(file)
            sites += [(file, mutant, source) for mutant in found]
        random.Random(f"{seed} {self.piece.name}").shuffle(sites)
        result, at = Result(self.piece), 0
        while at < len(sites) and result.caught + len(result.survivors) < count:
            wanted = count - result.caught - len(result.survivors)
            batch = list(enumerate(sites))[at:at + wanted]
            at += len(batch)
            for (_, (file, mutant, source)), outcome in zip(batch, pool.map(
                    lambda site: self.try_mutant(site[0], site[1][0], site[1][1]), batch)):
                result.caught += outcome == "caught"
                if outcome == "survived":
                    line = f"{file}:{mutant.line_in(source)}: {mutant.kind}: {mutant.words(source)}"
                    result.survivors.append(line)
        return result


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pieces", nargs="*", help="paths of pieces, or parts of them; default: all of the table")
    parser.add_argument("--count", type=int, default=20, help="mutants of each piece")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--share", type=float, default=0.9, help="that has to be caught of each piece")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--survivors", action="store_true", help="print the mutants that no test caught")
    parser.add_argument("--plain-headers", action="store_true", help="precompile none: for pieces that include little")
    parser.add_argument("--table", type=pathlib.Path, default=HERE / "pieces.txt")
    parser.add_argument("--root", type=pathlib.Path, default=HERE.parents[1], help="checkout whose sources are copied")
    parser.add_argument("--work", type=pathlib.Path,
                        default=pathlib.Path(tempfile.gettempdir()) / f"meridian-mutants-{os.getuid()}")
    return parser.parse_args()


def main():
    options = arguments()
    options.work.mkdir(parents=True, exist_ok=True)
    pieces = [piece for piece in read_pieces(options.table)
              if not options.pieces or any(name in piece.name for name in options.pieces)]
    if not pieces:
        raise SystemExit("no such piece")
    builder = Builder(options.root.resolve(), options.work.resolve(), options.jobs, not options.plain_headers)
    builder.prepare(pieces)
    results = []
    print(f"{'piece':60} caught  mutants  share")
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for piece in pieces:
            result = Campaign(builder, piece).draw(options.count, options.seed, pool)
            results.append(result)
            print(f"{piece.name:60} {result.caught:6}  {result.caught + len(result.survivors):7}  {100 * result.share():4.0f} %",
                  flush=True)
            if options.survivors:
                print("".join(f"  {line}\n" for line in result.survivors), end="", flush=True)
    caught, all_of_them = sum(r.caught for r in results), sum(r.caught + len(r.survivors) for r in results)
    below = [result.piece.name for result in results if result.share() < options.share]
    print(f"{'all':60} {caught:6}  {all_of_them:7}  {100 * caught / max(1, all_of_them):4.0f} %")
    print(f"{len(below)} of {len(results)} pieces under {100 * options.share:.0f} %" + "".join(f"\n  {name}" for name in below))
    return 1 if below else 0


if __name__ == "__main__":
    sys.exit(main())
