# SPDX-License-Identifier: Apache-2.0
"""Runs the blocks of docs/python.md, one after the other, as a reader would."""
import importlib.util
import os
import re
import tempfile

page = os.path.join(os.environ["MERIDIAN_SOURCE_DIR"], "docs", "python.md")
with open(page, encoding="utf-8") as file:
    blocks = re.findall(r"^```python\n(.*?)^```$", file.read(), re.S | re.M)
assert len(blocks) >= 4, "the page has lost its blocks"

os.chdir(os.environ["MERIDIAN_SOURCE_DIR"])
names = {}
with tempfile.TemporaryDirectory() as folder:
    for block in blocks:
        plot = "matplotlib" in block
        if plot and importlib.util.find_spec("matplotlib") is None:
            print("no matplotlib: the plot is not drawn")
            continue
        if plot:
            os.chdir(folder)
        exec(compile(block, page, "exec"), names)
        if plot:
            assert os.path.getsize("joints.png") > 1000
    os.chdir("/")
print(f"{len(blocks)} blocks ran")
