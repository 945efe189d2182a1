#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Faults, tried and counted: kills, calls that fail, full disks, damage, two runs at once.

    tests/faults/faults.py --lacuna PROGRAM --bench PROGRAM [--share 1] [--kinds kills,calls,...] [--seed 1]

After each fault the same command runs again. It must end with the bytes of an undisturbed run without a
workspace, or with exit code 1 and exactly one line `lacuna: error: ...`. A results folder that has holes.json
must be whole, whenever it is examined. The program prints a table in Markdown, and each wrong case on stderr.
Its exit code is 1 if a case was wrong. It needs strace, and the right to mount for full disks.
"""
import argparse
import concurrent.futures
import contextlib
import os
import queue
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from pathlib import Path

RESULTS = ["holes.json", "holes.csv", "loops.ply", "boundary.ply", "sample.ply", "points.ply"]
LONGEST = 90  # seconds of a run, beyond which it hangs
SIGNALS = [signal.SIGKILL, signal.SIGTERM, signal.SIGINT]
WORKERS = 2  # each runs one case at a time, and most of these have one thread
TASKS = 3
# Level 1 has so few points that one task makes it.
STEPS = {"survey": TASKS, "tiles": 1, "bucket": TASKS, "level-0": TASKS, "evaluate-0": TASKS, "level-1": 1,
         "evaluate-1": TASKS}


def contents(folder):
    files = {name: Path(folder, name) for name in RESULTS}
    return {name: file.read_bytes() for name, file in files.items() if file.exists()}


def remove(folder):
    shutil.rmtree(folder, ignore_errors=True)


class Run:
    """How a process ended."""

    def __init__(self, code, err, seconds=0.0):
        self.code, self.err, self.seconds = code, err, seconds

    def is_clear_failure(self):
        lines = [line for line in self.err.splitlines() if line and not line.startswith("lacuna: warning: ")]
        return self.code == 1 and len(lines) == 1 and lines[0].startswith("lacuna: error: ")

    def __str__(self):
        return "exit code %s, stderr %r" % (self.code, self.err[-400:])


class Setting:
    """What all cases share: the program, the scans, the results that are right."""

    def __init__(self, program, bench, folder, seed):
        self.program, self.bench, self.folder, self.seed = program, bench, folder, seed
        self.a, self.b = self.path("a.ply"), self.path("b.ply")
        self.synth(self.a, "100000", "--holes", "8")
        self.synth(self.b, "2000", "--holes", "1", "--translate", "0.3", "0.3", "0.2")
        out = self.path("right")
        run = self.run(["detect", self.a, self.b, "--out", out, *self.options()])
        if run.code != 0:
            sys.exit("the undisturbed run failed: %s" % run)
        self.right = contents(out)
        assert len(self.right) == len(RESULTS)

    def path(self, name):
        return os.path.join(self.folder, name)

    def synth(self, file, points, *more):
        subprocess.run([self.bench, "synth", "surface", file, "--points", points, "--kind", "waves",
                        "--positions", "random", *more], check=True, stdout=subprocess.DEVNULL)

    def options(self, threads=1):
        return ["--points", "--points-format", "ply", "--tile-points", "2000", "--threads", str(threads)]

    def start(self, arguments, before=()):
        quiet = [] if "--quiet" in arguments or arguments[0] == "plan" else ["--quiet"]
        return subprocess.Popen(["nice", "-n", "10", *before, self.program, *arguments, *quiet],
                                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True, errors="replace")

    def wait(self, process):
        try:
            _, err = process.communicate(timeout=LONGEST)
        except subprocess.TimeoutExpired:
            process.kill()
            _, err = process.communicate()
            return Run("none: it hangs", err)
        return Run(process.returncode, err)

    def run(self, arguments, before=()):
        return self.wait(self.start(arguments, before))


class Slot:
    """The folders of one worker, with workspaces to begin from."""

    def __init__(self, setting, number):
        self.setting = setting
        self.folder = setting.path("slot-%d" % number)
        os.mkdir(self.folder)
        self.workspace, self.out = self.path("workspace"), self.path("out")
        self.seconds = {}  # of a command, undisturbed
        self.keep("empty")
        self.do(self.detect(), "detect")
        self.keep("done")
        self.clear()
        self.do(self.plan(), "plan")
        self.keep("planned")
        for step, tasks in STEPS.items():
            for task in range(tasks):
                self.do(self.work(step, task), step)
            self.keep(step)
        self.do(self.finish(), "finish")
        if self.problem():
            sys.exit(self.problem())

    def path(self, name):
        return os.path.join(self.folder, name)

    # The commands.
    def detect(self, threads=1):
        return ["detect", self.setting.a, self.setting.b, "--workspace", self.workspace, "--out", self.out,
                *self.setting.options(threads)]

    def plan(self):
        return ["plan", self.setting.a, self.setting.b, "--workspace", self.workspace, "--tasks", str(TASKS),
                *self.setting.options()]

    def work(self, step, task=0):
        return ["work", self.workspace, "--step", step, "--task", str(task)]

    def finish(self):
        return ["finish", self.workspace, "--out", self.out]

    # The states.
    def do(self, arguments, name):
        start = time.time()
        run = self.setting.run(arguments)
        if run.code != 0:
            sys.exit("%s, undisturbed, failed: %s" % (name, run))
        self.seconds[name] = time.time() - start

    def keep(self, state):
        kept = self.path("state-" + state)
        os.mkdir(kept)
        for folder in (self.workspace, self.out):
            if os.path.exists(folder):
                shutil.copytree(folder, os.path.join(kept, os.path.basename(folder)))

    def clear(self):
        remove(self.workspace)
        remove(self.out)

    def begin(self, state):
        self.clear()
        for name in os.listdir(self.path("state-" + state)):
            shutil.copytree(os.path.join(self.path("state-" + state), name), self.path(name))

    # What is wrong with the results; None: nothing.
    def problem(self):
        found, right = contents(self.out), self.setting.right
        if found == right:
            return None
        return "results differ: %s" % " ".join(name for name in RESULTS if found.get(name) != right[name])

    # None, "part" where files lie there without holes.json, or what is wrong.
    def half_written(self):
        found = contents(self.out)
        if not found:
            return None
        return self.problem() if "holes.json" in found else "part"


class Case:
    """A command, and the state that it begins with."""

    def __init__(self, name, state, arguments, seconds, then_finish=False):
        self.name, self.state, self.arguments = name, state, arguments
        self.seconds, self.then_finish = seconds, then_finish


def case_of(slot, name, draw):
    if name == "detect":
        return Case(name, "empty", slot.detect(draw.choice([1, 1, 2])), slot.seconds["detect"])
    if name == "plan":
        return Case(name, "empty", slot.plan(), slot.seconds["plan"], True)
    if name == "finish":
        state = draw.choice(["planned", "evaluate-0", "evaluate-1"])
        return Case(name, state, slot.finish(), slot.seconds["detect"])
    before = dict(zip(STEPS, ["planned", *STEPS]))
    return Case("work " + name, before[name], slot.work(name, draw.randrange(STEPS[name])),
                slot.seconds[name], True)


COMMANDS = ["detect", "plan", *STEPS, "finish"]


class Count:
    """How the cases of each row of the table ended."""

    def __init__(self):
        self.rows, self.lock = {}, threading.Lock()

    def add(self, row, *how):
        with self.lock:
            self.rows.setdefault(row, Counter()).update(how)

    def wrong(self, row, text):
        self.add(row, "wrong")
        print("WRONG: %s: %s: %s" % (row[0], row[1], text), file=sys.stderr, flush=True)

    def table(self):
        keys = ["tried", "stopped", "right at once", "one clear line", "right when run again", "then one clear line", "wrong"]
        lines = ["| fault | command | " + " | ".join(keys) + " |", "|---|---|" + "---:|" * len(keys)]
        for (fault, command), counter in [*sorted(self.rows.items()), (("all", ""), sum(self.rows.values(), Counter()))]:
            lines.append("| %s | %s | %s |" % (fault, command, " | ".join(str(counter[key]) for key in keys)))
        return "\n".join(lines)


def check_results_folder(slot, row, count, note, is_kill):
    half = slot.half_written()
    if half and not (half == "part" and is_kill):
        count.wrong(row, "%s: half written: %s" % (note, half))


def run_again(slot, case, row, count, note, may_fail=False):
    """Runs the same command undisturbed."""
    run = slot.setting.run(case.arguments)
    if run.code == 0 and case.then_finish:
        run = slot.setting.run(slot.finish())
    if run.code == 0:
        problem = slot.problem()
        if problem:
            return count.wrong(row, "%s: again: %s" % (note, problem))
        return count.add(row, "right when run again")
    if may_fail and run.is_clear_failure():
        return count.add(row, "then one clear line")
    return count.wrong(row, "%s: again: %s" % (note, run))


def note_first(slot, case, run, row, count, note):
    """How the disturbed run ended. Returns whether that was right."""
    if run.code == 0:
        problem = None if case.then_finish else slot.problem()
        if problem:
            count.wrong(row, "%s: exit code 0, but %s" % (note, problem))
            return False
        count.add(row, "right at once")
    elif run.is_clear_failure():
        count.add(row, "one clear line")
    else:
        count.wrong(row, "%s: %s" % (note, run))
        return False
    return True


# 1. Kills.

def kill_once(setting, arguments, seconds, sent, draw):
    process = setting.start(arguments)
    try:
        process.wait(draw.random() * seconds * 1.05)
    except subprocess.TimeoutExpired:
        process.send_signal(sent)
    sent_at = time.time()
    run = setting.wait(process)
    run.seconds = time.time() - sent_at
    return run


def kills(share, count, add_job):
    """SIGKILL, SIGTERM and SIGINT come at random moments, at times several in a row."""
    share_of = {"detect": 120, "plan": 20, "survey": 20, "tiles": 10, "bucket": 30, "level-0": 40, "evaluate-0": 50,
                "level-1": 50, "evaluate-1": 40, "finish": 80}
    for name in COMMANDS:
        for i in range(max(1, round(share_of[name] * share / 1.9))):
            def job(slot, draw, name=name):
                case = case_of(slot, name, draw)
                slot.begin(case.state)
                row = ("kill at a random moment", case.name)
                killed = 0
                notes = []
                for _ in range(draw.choice([1, 1, 1, 1, 2, 2, 3])):
                    for _ in range(8):  # until it is stopped before its end
                        sent = draw.choice(SIGNALS)
                        run = kill_once(slot.setting, case.arguments, case.seconds, sent, draw)
                        if run.code != 0:
                            break
                        if not killed:
                            slot.begin(case.state)
                    if run.code == 0:
                        break
                    notes.append(sent.name)
                    if run.code not in (-sent, 128 + sent):
                        return count.wrong(row, "%s: %s" % (" ".join(notes), run))
                    killed += 1
                    count.add(row, "tried", "stopped")
                    if sent != signal.SIGKILL and run.seconds > 2:
                        count.wrong(row, "%s took %.1f s" % (sent.name, run.seconds))
                    check_results_folder(slot, row, count, " ".join(notes), "SIGKILL" in notes)
                if killed:
                    run_again(slot, case, row, count, " ".join(notes))
            add_job(job)


def kills_at_calls(share, count, add_job):
    """SIGKILL comes at calls that change names: random moments seldom fall on these."""
    for name, calls in (("detect", 30), ("finish", 20)):
        for i in range(max(1, round(calls * share))):
            def job(slot, draw, name=name, i=i, calls=max(1, round(calls * share))):
                case = case_of(slot, name, draw)
                call = ["rename", "renameat2", "unlinkat", "fsync", "rmdir", "mkdir"][i % 6]
                kill_at(slot, case, call, draw, count, (i + draw.random()) / calls)
            add_job(job)


def kill_at(slot, case, call, draw, count, where):
    k = place_of(slot, case, call, where)
    if k is None:
        return
    row = ("kill at a call", case.name)
    note = "%s: SIGKILL at %s %d" % (case.name, call, k)
    slot.begin(case.state)
    run = slot.setting.run(case.arguments, strace(call, "signal=SIGKILL", k))
    count.add(row, "tried")
    if run.code == -signal.SIGKILL:
        count.add(row, "stopped")
    elif not note_first(slot, case, run, row, count, note):
        return
    check_results_folder(slot, row, count, note, True)
    run_again(slot, case, row, count, note)


# 2. Calls that fail once.

def strace(call, what, k):
    # Signals are lost where a filter stops the process.
    filter = [] if what.startswith("signal") else ["--seccomp-bpf"]
    return ["strace", "-f", "-qq", *filter, "-o", "/dev/null", "-e", "trace=" + call,
            "-e", "inject=%s:%s:when=%d" % (call, what, k)]


CALLS = ["write", "pwrite64", "fsync", "rename", "renameat2", "openat", "ftruncate", "fallocate", "mmap",
         "unlink", "sync_file_range"]
ERRORS = {"mmap": ["ENOMEM"], "openat": ["EIO", "ENOMEM"], "unlink": ["EIO"], "rename": ["EIO", "ENOSPC"]}
counted = {}  # by command and call: numbers of the calls of the thread that has most, behind the start
counted_lock = threading.Lock()


def count_calls(slot, case):
    log = slot.path("calls")
    slot.begin(case.state)
    slot.setting.run(case.arguments, ["strace", "-f", "-qq", "--seccomp-bpf", "-o", log, "-e",
                                      "trace=rt_sigaction,rmdir," + ",".join(CALLS)])
    number = {}  # by thread and call
    places = {}
    with open(log, errors="replace") as file:
        has_begun = False
        for line in file:
            match = re.match(r"(\d+) +(\w+)\((.*)", line)
            if not match:
                continue
            thread, call, rest = match.groups()
            has_begun = has_begun or (call == "rt_sigaction" and rest.startswith("SIGPIPE"))
            number[thread, call] = number.get((thread, call), 0) + 1
            is_message = call == "write" and re.match(r"[12],", rest)
            if has_begun and not is_message:
                places.setdefault(call, {}).setdefault(thread, []).append(number[thread, call])
    return {call: max(threads.values(), key=len) for call, threads in places.items()}


def place_of(slot, case, call, where):
    """The number of a call somewhere in the run, 0 <= where < 1. None: there is no such call."""
    key = (slot.folder, case.name, case.state)
    if key not in counted:
        found = count_calls(slot, case)
        with counted_lock:
            counted[key] = found
    numbers = counted[key].get(call)
    return numbers[int(where * len(numbers))] if numbers else None


def calls_that_fail(share, count, add_job):
    """Each call of the store and the writers fails once, at places spread over the run."""
    for name in ("detect", "finish"):
        for call in CALLS:
            places = max(1, round((9 if call in ("rename", "openat", "mmap", "fsync", "pwrite64", "renameat2")
                                   else 5) * share))
            for i in range(places):
                def job(slot, draw, name=name, call=call, i=i, places=places):
                    case = case_of(slot, name, draw)
                    if name == "detect":
                        case.arguments = slot.detect(1)
                    if name == "finish":
                        case.state = "evaluate-0"
                    k = place_of(slot, case, call, (i + draw.random()) / places)
                    if k is None:
                        return
                    error = draw.choice(ERRORS.get(call, ["ENOSPC", "EIO"]))
                    row = ("%s fails" % call, name)
                    note = "%s: %s %d gives %s" % (case.name, call, k, error)
                    slot.begin(case.state)
                    run = slot.setting.run(case.arguments, strace(call, "error=" + error, k))
                    count.add(row, "tried")
                    if note_first(slot, case, run, row, count, note):
                        check_results_folder(slot, row, count, note, False)
                        run_again(slot, case, row, count, note)
                add_job(job)


# 3. A full disk.

@contextlib.contextmanager
def disk(at, bytes):
    os.makedirs(at, exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=%d" % bytes, "tmpfs", at], check=True)
    try:
        yield at
    finally:
        subprocess.run(["umount", at], check=True)


def size_of(folder):
    return sum(os.path.getsize(os.path.join(folder, name)) for name in os.listdir(folder))


def full_disks(share, count, add_job):
    """The workspace on a disk that is full; then its folder is copied to a larger one, and goes on."""
    sizes = max(1, round(20 * share))
    for what in ("detect", "results"):
        for i in range(sizes if what == "detect" else max(1, sizes // 2)):
            def job(slot, draw, what=what, i=i, sizes=sizes if what == "detect" else max(1, sizes // 2)):
                case = case_of(slot, "detect", draw)
                row = ("full disk", "detect, its results" if what == "results" else what)
                full = size_of(os.path.join(slot.path("state-done"), "workspace"))
                part = (i + draw.random()) / sizes * 1.1
                disk_bytes = 65536 + int({"detect": part, "results": part / 4}[what] * full)
                note = "%s: disk of %d KiB" % (case.name, disk_bytes // 1024)
                slot.begin(case.state)
                with disk(slot.path("disk"), disk_bytes) as small_disk:
                    small = os.path.join(small_disk, "folder")
                    place = slot.out if what == "results" else slot.workspace
                    arguments = [small if argument == place else argument for argument in case.arguments]
                    if i % 2 and what != "results":
                        arguments += ["--scratch", slot.folder]
                    run = slot.setting.run(arguments)
                    count.add(row, "tried")
                    if run.code == 0 and what == "results":
                        shutil.copytree(small, slot.out)
                    is_right = note_first(slot, case, run, row, count, note)
                    if what == "results":
                        if run.code != 0 and os.path.exists(small) and contents(small):
                            count.wrong(row, note + ": results on a full disk")
                    elif os.path.exists(small):
                        remove(slot.workspace)
                        shutil.copytree(small, slot.workspace)
                if is_right:
                    check_results_folder(slot, row, count, note, False)
                    run_again(slot, case, row, count, note)
            add_job(job)


# 4. Damage.

def streams_of(path):
    """Places of the streams of a part, so that small ones are damaged as often as large ones."""
    entry, trailer = 64, 48
    data = Path(path).read_bytes()
    size = len(data)
    whole = [("all", [(0, size)])]
    if size < trailer or data[-8:] != b"lacuna03":
        return whole
    entries = struct.unpack_from("<Q", data, size - trailer)[0]
    begin = size - trailer - entries * entry
    if begin < 0:
        return whole
    streams = {"table": [(begin, size - begin)]}
    for at in range(begin, size - trailer, entry):
        name = data[at:at + 24].rstrip(b"\0").decode(errors="replace")
        _, offset, length = struct.unpack_from("<QQQ", data, at + 24)
        if 0 < length and offset + length <= begin:
            streams.setdefault(name, []).append((offset, length))
    return sorted(streams.items())


def harm(folder, draw):
    """Returns what it did."""
    names = sorted(name for name in os.listdir(folder) if os.path.isfile(os.path.join(folder, name)))
    full = [name for name in names if os.path.getsize(os.path.join(folder, name)) > 0]
    # Large files as often as small ones, and each kind of file as often as another.
    kind = draw.choice(sorted({re.sub("[0-9a-f]{16}", "#", name) for name in full}))
    name = draw.choice([name for name in full if re.sub("[0-9a-f]{16}", "#", name) == kind])
    path = os.path.join(folder, name)
    size = os.path.getsize(path)
    how = draw.choice(["flip", "flip", "flip near the end", "cut", "remove", "swap", "zeros", "longer"])
    stream, extents = draw.choice(streams_of(path))
    if how.startswith("flip"):
        with open(path, "r+b") as file:
            for _ in range(draw.choice([1, 1, 8, 64, 1000])):
                begin, length = draw.choice(extents)
                at = size - 1 - draw.randrange(min(size, 200)) if "end" in how else begin + draw.randrange(length)
                file.seek(at)
                byte = file.read(1)[0]
                file.seek(at)
                file.write(bytes([byte ^ (1 << draw.randrange(8))]))
    elif how == "cut":
        os.truncate(path, draw.randrange(size))
    elif how == "remove":
        os.remove(path)
    elif how == "swap":
        other = draw.choice([n for n in names if n != name])
        os.rename(path, path + ".other")
        os.rename(os.path.join(folder, other), path)
        os.rename(path + ".other", os.path.join(folder, other))
        return "swap %s with %s" % (name, other)
    elif how == "zeros":
        with open(path, "r+b") as file:
            file.seek(draw.randrange(size))
            file.write(bytes(min(4096, size - file.tell())))
    else:
        with open(path, "ab") as file:
            file.write(bytes(draw.randrange(256) for _ in range(draw.choice([1, 24, 4096]))))
    return "%s %s" % (how, name + (" (%s)" % stream if how == "flip" else ""))


def damage(share, count, add_job):
    """Bits flipped, files cut, removed, swapped, overwritten with zeros, made longer."""
    for i in range(max(3, round(66 * share))):
        def job(slot, draw, i=i):
            what = ["detect", "finish", "work, then finish"][i % 3]
            case = case_of(slot, "detect" if what == "detect" else "finish", draw)
            slot.begin(draw.choice(["evaluate-0", "evaluate-1"]) if what == "work, then finish" else "done")
            remove(slot.out)
            done = ", ".join(harm(slot.workspace, draw) for _ in range(draw.choice([1, 1, 1, 2, 3])))
            row = ("damage", what)
            note = "%s: %s" % (case.name, done)
            count.add(row, "tried")
            if what == "work, then finish":
                step = draw.choice(list(STEPS))
                note = "work %s: %s" % (step, done)
                run = slot.setting.run(slot.work(step))
                if run.code != 0 and not run.is_clear_failure():
                    return count.wrong(row, "%s: %s" % (note, run))
            run = slot.setting.run(case.arguments)
            if note_first(slot, case, run, row, count, note):
                check_results_folder(slot, row, count, note, False)
                if run.code != 0:
                    run_again(slot, case, row, count, note, may_fail=True)
        add_job(job)


# 5. Two runs at once.

def two_at_once(share, count, add_job):
    """Two of each command on one workspace, and work while finish runs."""
    pairs = [("detect", "detect")] * 2 + [("finish", "finish")]
    pairs += [(step, step) for step in STEPS] + [(step, "finish") for step in STEPS]
    for names in pairs:
        for i in range(max(1, round(5 * share))):
            def job(slot, draw, names=names):
                case = case_of(slot, names[0], draw)
                is_unit = case.then_finish
                slot.begin(case.state)
                row = ("two at once", " and ".join(names))
                second = case.arguments if names[0] == names[1] else case_of(slot, names[1], draw).arguments
                first_run = slot.setting.start(case.arguments)
                pause = draw.random() ** 2 * case.seconds
                time.sleep(pause)
                second_run = slot.setting.start(second)
                runs = [slot.setting.wait(first_run), slot.setting.wait(second_run)]
                note = "%s, %s, %.2f s later" % (case.name, names[1], pause)
                count.add(row, "tried")
                for run in runs:
                    if run.code == 0:
                        continue
                    if not run.is_clear_failure():
                        return count.wrong(row, "%s: %s" % (note, run))
                    if is_unit and names[0] == names[1]:
                        return count.wrong(row, "%s: a copy of a unit fails: %s" % (note, run))
                if any(run.code != 0 for run in runs):
                    count.add(row, "one clear line")
                else:
                    count.add(row, "right at once")
                if any(run.code == 0 for run in runs) and not is_unit and slot.problem():
                    return count.wrong(row, "%s: %s, then %s: %s" % (note, runs[0], runs[1], slot.problem()))
                if names[1] == "finish" and runs[1].code == 0 and slot.problem():
                    return count.wrong(row, "%s: finish: %s" % (note, slot.problem()))
                run_again(slot, case, row, count, note)
            add_job(job)


KINDS = {"kills": kills, "kills-at-calls": kills_at_calls, "calls": calls_that_fail, "disks": full_disks,
         "damage": damage, "two": two_at_once}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lacuna", required=True, help="the program to test")
    parser.add_argument("--bench", required=True, help="lacuna-bench, which makes the scans")
    parser.add_argument("--share", type=float, default=1, help="of the counts, such as 0.1")
    parser.add_argument("--kinds", default=",".join(KINDS), help="default: all")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    start = time.time()
    folder = tempfile.mkdtemp(prefix="lacuna-faults-", dir="/dev/shm" if os.path.isdir("/dev/shm") else None)
    count = Count()
    try:
        setting = Setting(os.path.abspath(arguments.lacuna), os.path.abspath(arguments.bench), folder, arguments.seed)
        jobs = []
        for kind in arguments.kinds.split(","):
            KINDS[kind](arguments.share, count, jobs.append)
        random.Random(arguments.seed).shuffle(jobs)
        slots = queue.SimpleQueue()  # of those that are free
        for number in range(WORKERS):
            slots.put(Slot(setting, number))

        def do(number):
            slot = slots.get()
            try:
                jobs[number](slot, random.Random("%d %d" % (arguments.seed, number)))
            except Exception as error:
                count.wrong(("the harness", type(error).__name__), repr(error))
            slots.put(slot)

        with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
            list(pool.map(do, range(len(jobs))))
        print(count.table())
        print("\n%d cases in %.0f minutes." % (len(jobs), (time.time() - start) / 60))
    finally:
        remove(folder)
    return 1 if any(counter["wrong"] for counter in count.rows.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
