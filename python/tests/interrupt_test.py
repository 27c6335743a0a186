# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Ctrl-C ends what waits, and the interpreter ends whatever is under way."""
import os
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import unittest
from pathlib import Path

import dxslam
import recording

PATIENCE = 60  # seconds; what is tested takes a small part of one


def press_control_c(after=0.3):
    timer = threading.Timer(after, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    return timer


def threads_of_this_process():
    return len(os.listdir("/proc/self/task")) - threading.active_count()


def write_long_trajectory(path):
    """One that takes a good second to read."""
    with open(path, "w", encoding="utf-8") as file:
        for i in range(1000):
            file.write("".join(f"{1000 * i + j} 0 0 0 0 0 0 1\n" for j in range(1000)))


class ControlC(unittest.TestCase):
    def test_waiting_for_an_event(self):
        events = recording.system().subscribe()
        slam = recording.system()
        for wait in (lambda: slam.subscribe().next(), lambda: next(slam.subscribe()),
                     lambda: slam.subscribe().next(timeout=PATIENCE)):
            press_control_c()
            with self.assertRaises(KeyboardInterrupt):
                wait()
        del events

    def test_loading(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "trajectory.txt"
            write_long_trajectory(path)
            before = threads_of_this_process()
            press_control_c(after=0.1)
            with self.assertRaises(KeyboardInterrupt):
                dxslam.Trajectory.read(path)
            # It was not waited for: the thread that loads still does.
            self.assertEqual(threads_of_this_process(), before + 1)

    def test_finishing(self):
        gate = threading.Event()
        slam = recording.system(on_frame=lambda _: gate.wait(PATIENCE))
        for image in recording.images()[:2]:
            slam.process(*image)
        press_control_c(after=0.3)
        timer = threading.Timer(1.0, gate.set)
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            slam.finish()
        self.assertTrue(gate.is_set())
        self.assertEqual(len(slam.frames()), 2)  # the results can be read all the same

    def test_processing(self):
        done = 0
        press_control_c()
        with self.assertRaises(KeyboardInterrupt):
            with recording.system() as slam:
                start = time.monotonic()
                while time.monotonic() < start + PATIENCE:
                    slam.process(float(done), *recording.images()[done % 8][1:])
                    done += 1
        self.assertGreater(len(slam.frames()), 0)


class Exit(unittest.TestCase):
    def run_script(self, text):
        script = f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r})\n"
        script += "import dxslam, recording\n" + textwrap.dedent(text)
        done = subprocess.run([sys.executable, "-X", "faulthandler", "-c", script],
                              capture_output=True, text=True, timeout=PATIENCE)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        return done.stdout

    def test_with_a_system_that_is_not_finished(self):
        self.run_script("""
            seen = []
            slam = recording.system(on_frame=seen.append)
            events = slam.subscribe()
            for image in recording.images()[:3]:
                slam.process(*image)
        """)

    def test_with_a_reader_that_still_waits(self):
        self.run_script("""
            import threading
            slam = recording.system()
            threading.Thread(target=list, args=[slam.subscribe()], daemon=True).start()
            slam.process(*recording.images()[0])
        """)

    def test_with_a_load_that_is_under_way(self):
        said = self.run_script("""
            import pathlib, tempfile, interrupt_test
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "trajectory.txt"
                interrupt_test.write_long_trajectory(path)
                interrupt_test.press_control_c(after=0.1)
                try:
                    dxslam.Trajectory.read(path)
                except KeyboardInterrupt:
                    print("interrupted")
        """)
        self.assertEqual(said, "interrupted\n")


if __name__ == "__main__":
    unittest.main()
