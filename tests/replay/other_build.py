#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A build that moves otherwise: MERIDIAN_TOOL's recording with the last digit of its last row changed."""
import os
import pathlib
import subprocess
import sys

code = subprocess.run([os.environ["MERIDIAN_TOOL"], *sys.argv[1:]], check=False).returncode
if "--record" in sys.argv:
    recording = pathlib.Path(sys.argv[sys.argv.index("--record") + 1])
    text = recording.read_bytes().rstrip()
    recording.write_bytes(text[:-1] + (b"1" if text[-1:] != b"1" else b"2") + b"\n")
sys.exit(code)
