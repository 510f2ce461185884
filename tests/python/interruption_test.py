"""Long work: other threads go on, signals end it."""

import os
import signal
import threading
import time
import unittest

import exemplar


class Alarm(Exception):
    pass


class LongWorkTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.large = exemplar.make_shape("octopus", faces=40000)
        cls.small = exemplar.make_shape("octopus", faces=1000)

    def interrupted(self, error, send):
        """Seconds of all processors that work goes on after half a second, when `send` is called."""
        sent = []
        timer = threading.Timer(0.5, lambda: (sent.append(time.process_time()), send()))
        timer.start()
        with self.assertRaises(error):
            exemplar.features(self.large)  # twenty seconds of a processor
        self.assertTrue(sent, "the work ended too early to be interrupted: it tests nothing")
        return time.process_time() - sent[0]

    def test_ctrl_c_ends_it_soon(self):
        self.assertLess(self.interrupted(KeyboardInterrupt, lambda: os.kill(os.getpid(), signal.SIGINT)), 5)
        # What was given up leaves nothing behind that would end other work.
        self.assertEqual(exemplar.features(self.small, samples=50).values.shape[0], self.small.face_count)

    def test_other_signal_handlers_may_end_it(self):
        def ring(number, frame):
            raise Alarm("enough")

        before = signal.signal(signal.SIGALRM, ring)
        try:
            self.assertLess(self.interrupted(Alarm, lambda: os.kill(os.getpid(), signal.SIGALRM)), 5)
        finally:
            signal.signal(signal.SIGALRM, before)

    def test_a_handler_that_raises_nothing_does_not_end_it(self):
        heard = []
        before = signal.signal(signal.SIGALRM, lambda number, frame: heard.append(number))
        try:
            signal.setitimer(signal.ITIMER_REAL, 0.05, 0.05)
            exemplar.features(self.small)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)
        self.assertIn(signal.SIGALRM, heard)

    def test_other_threads_go_on(self):
        ticks, done = [], threading.Event()

        def tick():
            while not done.wait(0.005):
                ticks.append(time.monotonic())

        thread = threading.Thread(target=tick)
        thread.start()
        begin = time.monotonic()
        exemplar.features(self.small)
        end = time.monotonic()
        done.set()
        thread.join()
        during = sum(begin + 0.1 * (end - begin) < t < end - 0.1 * (end - begin) for t in ticks)
        self.assertGreater(during, 3, f"{end - begin:.2f} s")

    def test_threads_may_share_a_mesh(self):
        results = []
        threads = [threading.Thread(target=lambda: results.append(exemplar.features(self.small, samples=50).values))
                   for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(results), 3)
        self.assertTrue(all((values == results[0]).all() for values in results))


if __name__ == "__main__":
    unittest.main()
