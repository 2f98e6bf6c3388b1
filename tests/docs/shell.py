# SPDX-License-Identifier: Apache-2.0
"""A reader's shell, and whether what it printed is what a page shows."""
import os
import re
import select
import signal
import subprocess
import time

LAST_WORD = "walk: the block ended"
LONGEST_S = 240  # of a script, on a busy host


def matches(wanted, printed):
    """Whether the lines `printed` are the lines `wanted`; `...` as walk_page.py says."""
    if not wanted:
        return not printed
    if wanted[0].strip() == "...":
        return any(matches(wanted[1:], printed[n:]) for n in range(len(printed) + 1))
    if not printed:
        return False
    pattern = ".*".join(re.escape(part) for part in wanted[0].rstrip().split("..."))
    return re.fullmatch(pattern, printed[0].rstrip()) is not None and matches(wanted[1:], printed[1:])


def eventually(is_so, patience_s):
    end = time.monotonic() + patience_s
    while not (so := is_so()) and time.monotonic() < end:
        time.sleep(0.05)
    return so


class Shell:
    """Runs scripts one after the other in one bash. What they start in the background ends with it."""

    def __init__(self, folder):
        self.folder, self.count, self.beside = folder, 0, []
        environment = {**os.environ, "MERIDIAN_DOMAIN": str(20 + os.getpid() % 40), "TERM": "dumb"}
        self.process = subprocess.Popen(["bash"], cwd=folder, stdin=subprocess.PIPE, text=True,
                                        stdout=subprocess.PIPE, env=environment, start_new_session=True)
        self.send("set -e -o pipefail")

    def send(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def answer(self):
        """A line of the shell; "" where it ended or takes too long."""
        ready, _, _ = select.select([self.process.stdout], [], [], LONGEST_S)
        return self.process.stdout.readline().strip() if ready else ""

    def files(self, script):
        self.count += 1
        file, output = (self.folder / f".{self.count}.{kind}" for kind in ("sh", "out"))
        file.write_text(script)
        output.touch()
        return file, output

    def run(self, script):
        """The file of what `script` printed, and whether it went to its end, in time. One that fails ends the shell."""
        file, output = self.files(script)
        self.send(f"source {file} >{output} 2>&1\necho '{LAST_WORD}'")
        return output, self.answer() == LAST_WORD

    def run_apart(self, script):
        """The file of what `script` printed, and its exit code. The shell goes on, with nothing that it set."""
        file, output = self.files(script)
        self.send(f"set +e\n(set -e; source {file}) >{output} 2>&1\necho $?\nset -e")
        return output, int(self.answer() or -1)

    def start(self, script):
        """The file of what `script` prints while it runs beside what follows. Its standard input stays open."""
        file, output = self.files(script)
        self.send(f"source {file} >{output} 2>&1 < <(sleep infinity) &\necho $!")
        self.beside.append((self.answer(), output))
        return output

    def end_last(self, patience_s):
        """Ends what was started last, once it has printed something."""
        if not self.beside or not eventually(self.beside[-1][1].read_text, patience_s):
            return False
        process, _ = self.beside.pop()
        self.send(f"pkill -P {process}; wait {process} || true; echo")
        self.answer()
        return True

    def ended(self):
        """What those printed that were started and do not run any more."""
        return "".join(output.read_text(errors="replace") + "\n" for process, output in self.beside
                       if not os.path.exists(f"/proc/{process}"))

    def end(self):
        try:
            os.killpg(self.process.pid, signal.SIGTERM)
        except ProcessLookupError:
            pass
        self.process.wait()
