#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Wake-ups and transport of this host as others measure them, in the same minutes as `meridian probe`:
ddsperf, then the probe, which lets cyclictest take turns with the service, then ddsperf once more.
ddsperf has the settings of the service and, where there is a right to it, a real-time class. Exit
code 77: one of them is not there.
"""
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys

DEPLOY = pathlib.Path(__file__).resolve().parents[2] / "deploy"
SHOWN = re.compile(r"^(host|.*latency, us|  (Off|bare|cyclictest|cutting)[ :]|  periods lost|.*took away)")


def ddsperf(seconds):
    """Half of a round trip of 128 bytes at 1 kHz, best effort: count and medians of the seconds' p50
    and p99, us."""
    rights = ["chrt", "-f", "80"]
    settings = "cyclonedds-loopback-rt.xml"
    if subprocess.run([*rights, "true"], capture_output=True, check=False).returncode:
        rights, settings = [], "cyclonedds-loopback.xml"
    environment = {**os.environ, "CYCLONEDDS_URI": f"file://{DEPLOY / settings}"}
    command = [*rights, "ddsperf", "-i", str(200 + os.getpid() % 20), "-u"]
    with subprocess.Popen([*command, "-D", str(seconds + 3), "pong"], env=environment,
                          stdout=subprocess.DEVNULL):
        said = subprocess.run([*command, "-D", str(seconds), "ping", "1kHz", "size", "128"], text=True,
                              env=environment, stdout=subprocess.PIPE, check=False).stdout
    rows = re.findall(r" 50% ([\d.]+)us .* 99% ([\d.]+)us .* cnt (\d+)", said)
    if not rows:
        sys.exit(f"ddsperf measured nothing:\n{said}")
    p50, p99, count = zip(*rows)
    return (sum(map(int, count)), statistics.median(map(float, p50)), statistics.median(map(float, p99)))


def main():
    meridian, seconds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 20
    for program in ("ddsperf", "cyclictest"):
        if not shutil.which(program):
            print(f"{program} is not there (deploy/install_packages peers)")
            sys.exit(77)
    before = ddsperf(seconds)
    probe = subprocess.run([meridian, "probe", "--for", str(seconds)], capture_output=True, text=True,
                           check=False)
    after = ddsperf(seconds)
    shown = [line for line in probe.stdout.splitlines() if SHOWN.match(line)]
    if not any("cyclictest" in line for line in shown):
        sys.exit(f"meridian probe: {probe.stdout}{probe.stderr}")
    print(*shown, sep="\n")
    for when, (count, p50, p99) in (("before", before), ("behind", after)):
        print(f"  ddsperf {when}: one way    {count:10} {p50:9.1f} {p99:9.1f}")


if __name__ == "__main__":
    main()
