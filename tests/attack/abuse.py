# SPDX-License-Identifier: Apache-2.0
"""Minutes of the worst mixed abuse: memory, descriptors and threads of service and drives must stay
flat, and the cycle inside its budgets."""
import json
import os
import pathlib
import random
import threading
import time

import attacks
from figures import Recording, spread
from plant import Plant
from situations import LIMIT_MS, STOPPED, Situations, write_parts

MAX_GROWTH_KB_PER_10_MIN = 1024  # of resident memory, over the second half
MAX_DRIFT = 2                    # descriptors and threads that may differ between begin and end


def sample(process):
    """Resident memory in kB, descriptors and threads of a process."""
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    values = dict(line.split(":", 1) for line in status.splitlines())
    return (int(values["VmRSS"].split()[0]), len(os.listdir(f"/proc/{process.pid}/fd")),
            int(values["Threads"]))


def slope_per_10_min(times_s, values):
    """Of the straight line that fits them best."""
    n = len(times_s)
    if n < 2:
        return 0.0
    mean_t, mean_v = sum(times_s) / n, sum(values) / n
    square = sum((t - mean_t) ** 2 for t in times_s)
    return 600 * sum((t - mean_t) * (v - mean_v) for t, v in zip(times_s, values)) / square


def flatness(name, rows):
    """What is said of a process, and what is wrong with it."""
    if len(rows) < 4:
        return f"{name}: gone", [f"{name} ended"]
    half = rows[len(rows) // 2:]
    growth = slope_per_10_min([r[0] for r in half], [r[1] for r in half])
    files, threads = [[r[i] for r in half] for i in (2, 3)]
    text = (f"{name}: resident {rows[0][1]} kB at the begin, {half[0][1]} half way, {half[-1][1]} "
            f"at the end, slope of the second half {growth:.0f} kB per 10 min; descriptors "
            f"{min(files)} to {max(files)}, threads {min(threads)} to {max(threads)}")
    wrong = []
    if growth > MAX_GROWTH_KB_PER_10_MIN:
        wrong.append(f"{name}: resident memory grows by {growth:.0f} kB per 10 min")
    for what, values in (("descriptors", files), ("threads", threads)):
        quarter = max(1, len(values) // 4)
        if spread(values[-quarter:])["p50"] - spread(values[:quarter])["p50"] > MAX_DRIFT:
            wrong.append(f"{name}: {what} grow: {values[0]} to {values[-1]}")
    return text, wrong


def sample_until(over, processes, rows, begin):
    """Once a second."""
    while not over.wait(1):
        for name, process in processes.items():
            try:
                rows[name].append((time.monotonic() - begin, *sample(process)))
            except (OSError, KeyError):
                pass  # it has ended


def run(arguments, settings):
    plant = Plant(arguments.programs, settings=settings, keep_logs=arguments.keep)
    draw = random.Random(arguments.seed)
    rows, wrong = {"meridiand": [], "drives": []}, []
    try:
        write_parts(plant.folder)
        attacks.start_plant(plant, attacks.ATTACKS["none"], arguments.seed, "")
        if not plant.enable(20):
            print("never Ready")
            return 1
        situations = Situations(plant, draw)
        attacks.begin(plant, attacks.ATTACKS["mixed"], arguments.seed)
        begin = time.monotonic()
        end = begin + 60 * arguments.abuse
        processes = {"meridiand": plant.service, "drives": plant.drives}
        print(f"abuse for {arguments.abuse:g} min, seed {arguments.seed}", flush=True)
        over = threading.Event()
        watch = threading.Thread(target=sample_until, args=(over, processes, rows, begin))
        watch.start()
        while time.monotonic() < end:
            for what, seconds in (("cut_hold", 6), ("jog", 2), ("cut_abort", 2)):
                getattr(situations, what)(min(end, time.monotonic() + seconds))
        over.set()
        watch.join()
        report = plant.operator.report()
        plant.stop_others()
        latency = plant.start([plant.programs / "meridian", "status", "--latency", "--domain",
                               plant.domain.number, "--machine-name", plant.machine],
                              "latency.log")
        latency.wait(20)
        plant.stop_service()
        recording = Recording(plant.recording) if plant.recording.exists() else None
        late = []
        for one in situations.samples:
            found = recording and recording.stop_after(one["written_ns"], LIMIT_MS * 1_000_000,
                                                        STOPPED[one["verb"]])
            late.append(found[0] if found else None)
        lost = sum(one is None for one in late)
        seen = spread([one for one in late if one is not None])
        for name, of_process in rows.items():
            text, more = flatness(name, of_process)
            print(text)
            wrong += more
        if lost:
            wrong.append(f"{lost} of {len(late)} stops not obeyed within {LIMIT_MS} ms")
        if report["followed"]:
            wrong.append(f"{report['followed']} reports of drives that followed a stranger")
        print(f"stops: {len(late)}, not obeyed {lost}; seen ms p50 {seen['p50']:.2f}, "
              f"p99 {seen['p99']:.2f}, p99.9 {seen['p999']:.2f}, max {seen['max']:.2f}")
        print(plant.log("latency.log"))
        for reason in dict.fromkeys(situations.failed):
            print(f"not brought about: {reason} ({situations.failed.count(reason)} times)")
        print("wrong: " + ("; ".join(wrong) or "nothing"))
        if arguments.json:
            pathlib.Path(arguments.json).write_text(json.dumps(
                {"rows": rows, "wrong": wrong, "report": report, "late_ms": late}))
    finally:
        plant.close()
    return 1 if wrong else 0
