# SPDX-FileCopyrightText: The holdfast authors
# SPDX-License-Identifier: Apache-2.0
"""Long work lets other threads run, tells how far it is, ends at Ctrl-C, and leaves all whole."""
import concurrent.futures
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time

import holdfast
import numpy as np
import pytest
from holdfast import Robot


def test_threads_share_robots():
    robots = [holdfast.generate('arm', size) for size in range(6, 46)] * 5
    alone = [robot.check().load_ratio_max for robot in robots]
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda robot: robot.check(threads=2).load_ratio_max, robots))
    assert alone == together


def test_processes_take_robots_and_give_reports():
    robots = [holdfast.generate('arm', size) for size in (6, 10, 20)]
    holdfast.generate('cube', 12).check()  # Threads that do not follow into the new processes.
    with multiprocessing.get_context('fork').Pool(2) as pool:
        reports = pool.map(Robot.check, robots)
    assert [report.load_ratio_max for report in reports] == [
        robot.check().load_ratio_max for robot in robots]


def test_other_threads_run_meanwhile():
    ticks = []
    is_over = threading.Event()

    def tick():
        while not is_over.wait(0.005):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    robot = holdfast.generate('cube', 30)
    thread.start()
    start = time.monotonic()
    robot.check()
    end = time.monotonic()
    is_over.set()
    thread.join()
    inside = [t for t in ticks if start < t < end]
    assert len(inside) > (end - start) / 0.1


# What each of them does, and what it would take without end: some ten seconds or more.
LONG_WORK = {
    'check': "holdfast.generate('cube', 100).check()",
    'check on one thread': "holdfast.generate('cube', 100).check(threads=1)",
    'check_many': "holdfast.check_many([holdfast.generate('arm', 29)] * 50_000)",
    'limit': "holdfast.generate('growth', 2000).check(limit=True)",
    'proof': "holdfast.generate('cube', 30).check(proof=True)",
    'next': "holdfast.generate('cube', 40).next()",
    'steps': "holdfast.steps(holdfast.generate('cube', 6), [{'attach': [[-1, 0, 0]]}, "
             "{'detach': [[-1, 0, 0]]}] * 20_000)",
    'order': "holdfast.order(holdfast.generate('cube', 20), seconds=1000)",
    'move': "holdfast.move(holdfast.Robot([[x, 0, 0] for x in range(40)]), "
            "holdfast.Robot([[0, x, 0] for x in range(40)]), seconds=1000)",
    'simulate': "holdfast.generate('cube', 12).simulate()",
    'report': "[big.json() for _ in range(1000)]",
}

SCRIPT = '''
import holdfast, os, signal, sys, threading, time
big = holdfast.generate('cube', 30).check()
sent = None

def interrupt():
    global sent
    time.sleep({delay})
    sent = time.monotonic()
    os.kill(os.getpid(), signal.SIGINT)

threading.Thread(target=interrupt, daemon=True).start()
try:
    {work}
    print('ended', time.monotonic() - sent if sent else None)
except KeyboardInterrupt:
    print('interrupted', time.monotonic() - sent)
assert holdfast.generate('cube', 12).check().verdict is not None
'''


@pytest.mark.parametrize('name', LONG_WORK)
def test_ctrl_c_ends_long_work(name):
    script = SCRIPT.format(work=LONG_WORK[name], delay=0.7)
    done = subprocess.run([sys.executable, '-c', script], capture_output=True, text=True,
                          timeout=120)
    assert done.returncode == 0, done.stderr
    how, seconds = done.stdout.split()
    if how == 'interrupted':
        # 0.2 s; a busy machine takes longer to let anybody run.
        assert float(seconds) < 0.2 * float(os.environ.get('HOLDFAST_TEST_PATIENCE', '5'))


ENDS_MEANWHILE = '''
import holdfast, threading, time

def work():
    while True:
        {work}

for _ in range({count}):
    threading.Thread(target=work, daemon=True).start()
time.sleep(0.5)
print('ended')
'''


@pytest.mark.parametrize('count', [1, 3])
@pytest.mark.parametrize('work', [
    LONG_WORK['check'], LONG_WORK['check_many'], LONG_WORK['simulate'],
    "holdfast.generate('arm', 29).check().json()",
    "holdfast.generate('cube', 40).check(progress=lambda *_: sum(range(100_000)))"])
def test_a_program_ends_while_daemon_threads_work(work, count):
    """Python gives them the GIL no more; an abort would be a return code of -6."""
    script = ENDS_MEANWHILE.format(work=work, count=count)
    done = subprocess.run([sys.executable, '-c', script], capture_output=True, text=True,
                          timeout=120)
    assert (done.returncode, done.stdout, done.stderr) == (0, 'ended\n', '')


def test_progress_is_told_and_its_errors_arrive():
    told = []
    holdfast.generate('cube', 40).check(progress=lambda *numbers: told.append(numbers))
    assert told and all(len(numbers) == 2 for numbers in told)
    told.clear()
    holdfast.check_many([holdfast.generate('arm', 29)] * 20_000,
                        progress=lambda *numbers: told.append(numbers))
    assert all(0 < done <= count == 20_000 for done, count in told)
    assert told[-1] == (20_000, 20_000)

    class Enough(Exception):
        pass

    def stop(*numbers):
        raise Enough

    robot = holdfast.generate('cube', 40)
    with pytest.raises(Enough):
        robot.check(progress=stop)
    assert np.isfinite(robot.check().load_ratio_max)
    with pytest.raises(TypeError):
        robot.check(progress=3)


def test_a_bar_is_drawn_if_tqdm_is_there(monkeypatch):
    import types
    bars = []

    class Bar:
        def __init__(self, desc):
            self.desc, self.n, self.total = desc, 0, None
            bars.append(self)

        def __enter__(self):
            return self

        def __exit__(self, *_):
            return False

        def refresh(self):
            pass

        def set_postfix_str(self, text):
            self.text = text

    monkeypatch.setitem(sys.modules, 'tqdm', types.SimpleNamespace(tqdm=Bar))
    holdfast.check_many([holdfast.generate('arm', 29)] * 20_000, progress=True)
    assert bars[0].desc == 'check' and 0 < bars[0].n <= bars[0].total == 20_000
    monkeypatch.setitem(sys.modules, 'tqdm', None)
    with pytest.warns(UserWarning, match='tqdm'):
        holdfast.generate('arm', 6).check(progress=True)
