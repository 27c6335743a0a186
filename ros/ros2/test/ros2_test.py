#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The dxslam authors
"""Real transport between the layer in ros/ros2 (its probe, probe.cpp) and rclpy, which knows nothing
of it. Run by ctest through scripts/ros2_env; DXSLAM_ROS2_PROBE names the probe.

No test checks a time, other than that a stopped program ends. Each waits for a sign.
"""
import fcntl
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import zlib
from pathlib import Path

PROBE = os.environ["DXSLAM_ROS2_PROBE"]
PATIENCE = 60.0  # seconds until a test gives up waiting for a sign


def own_domain():
    """Tests run side by side and must not meet: a number that no other process has, and its lock."""
    for number in range(100):
        domain = 1 + (os.getpid() + number) % 100
        lock = open(Path(tempfile.gettempdir()) / f"ros2_test_domain_{domain}", "w")
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return domain, lock
        except BlockingIOError:
            lock.close()
    sys.exit("ros2_test: no ROS domain is free")


DOMAIN, LOCK = own_domain()
LOGS = tempfile.TemporaryDirectory(prefix="ros2_test_")
os.environ["ROS_DOMAIN_ID"] = str(DOMAIN)
os.environ["ROS_LOG_DIR"] = LOGS.name

import rclpy  # noqa: E402
from builtin_interfaces.msg import Time  # noqa: E402
from dxslam_msgs.msg import Features, State  # noqa: E402
from dxslam_msgs.srv import SaveMap  # noqa: E402
from rcl_interfaces.msg import Log, ParameterEvent, ParameterType  # noqa: E402
from rcl_interfaces.srv import (  # noqa: E402
    DescribeParameters, GetParameters, GetParameterTypes, ListParameters, SetParameters,
    SetParametersAtomically)
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from rclpy.parameter import Parameter  # noqa: E402
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy  # noqa: E402
from rosgraph_msgs.msg import Clock  # noqa: E402
from sensor_msgs.msg import Image  # noqa: E402
from std_msgs.msg import Header  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402

LATCHED = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
BEST_EFFORT = QoSProfile(depth=10, reliability=QoSReliabilityPolicy.BEST_EFFORT)


class RosTest(unittest.TestCase):
    """A node of rclpy beside a probe."""

    def setUp(self):
        self.probes = []
        rclpy.init()
        self.node = rclpy.create_node("tester")
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)

    def tearDown(self):
        self.executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown()
        for probe in self.probes:  # whatever it did, it can end
            if probe.poll() is None:
                probe.send_signal(signal.SIGTERM)
                try:
                    _, errors = probe.communicate(timeout=PATIENCE)
                finally:
                    probe.kill()
                self.assertEqual(probe.returncode, 0, errors)
            probe.stderr.close()

    def start(self, *arguments, **options):
        probe = subprocess.Popen([PROBE, *arguments], stderr=subprocess.PIPE, text=True, **options)
        self.probes.append(probe)
        return probe

    def wait_for(self, what, condition):
        end = time.monotonic() + PATIENCE
        while not condition():
            for probe in self.probes:
                self.assertIn(probe.poll(), (None, 0, -9), f"the probe died, waiting for {what}")
            self.assertLess(time.monotonic(), end, f"waited in vain for {what}")
            self.executor.spin_once(0.05)

    def call(self, kind, name, request):
        client = self.node.create_client(kind, name)
        self.wait_for(name, client.service_is_ready)
        future = client.call_async(request)
        self.wait_for(f"an answer of {name}", future.done)
        self.node.destroy_client(client)
        return future.result()

    def collect(self, kind, topic, qos=10):
        messages = []
        self.node.create_subscription(kind, topic, messages.append, qos)
        return messages

    def counts(self):
        """Publishers of image, in the graph and connected; readers of image_back and of /tf."""
        return self.call(Trigger, "probe/count", Trigger.Request()).message

    def nodes(self):
        return {f"{space.rstrip('/')}/{name}"
                for name, space in self.node.get_node_names_and_namespaces()}


def picture(index, size=(640, 480)):
    """Deterministic noise, another for each index."""
    row = zlib.crc32(str(index).encode()).to_bytes(4, "little") * (size[0] * 3 // 4)
    return b"".join(bytes([(byte + y) & 255 for byte in row[:4]]) * (len(row) // 4)
                    for y in range(size[1]))


def image(index):
    message = Image(width=640, height=480, encoding="bgr8", step=640 * 3)
    message.header.stamp = Time(sec=index // 30, nanosec=index % 30 * 33_333_333)
    message.header.frame_id = "camera"
    message.data = picture(index)
    return message


class Topics(RosTest):
    def test_images_both_ways(self):
        """Sixty images of 640x480 at 30 Hz go there and come back: all, in order, unchanged."""
        self.start()
        back = self.collect(Image, "image_back", 100)
        transforms = self.collect(TFMessage, "/tf", 100)
        publisher = self.node.create_publisher(Image, "image", 100)
        self.wait_for("both ends", lambda: publisher.get_subscription_count() == 1 and
                      self.counts() == "1 1 1 1 ")
        sent = [image(index) for index in range(60)]
        for message in sent:
            begun = time.monotonic()
            publisher.publish(message)
            while time.monotonic() < begun + 1 / 30:
                self.executor.spin_once(0.01)
        self.wait_for("all images", lambda: len(back) >= 60 and len(transforms) >= 60)
        self.assertEqual([message.header.stamp for message in back],
                         [message.header.stamp for message in sent])
        for one, other in zip(back, sent):
            self.assertEqual((one.width, one.height, one.encoding, one.step, one.header.frame_id),
                             (640, 480, "bgr8", 1920, "camera"))
            self.assertEqual(bytes(one.data), bytes(other.data))
        self.assertEqual([message.transforms[0].transform.translation.x for message in transforms],
                         [float(index) for index in range(1, 61)])

    def test_who_comes_late_gets_the_latched_message(self):
        self.start()
        self.wait_for("the node", lambda: "/probe" in self.nodes())
        self.call(Trigger, "probe/count", Trigger.Request())  # by now it has published
        states = self.collect(State, "probe/state", LATCHED)
        features = self.collect(Features, "probe/features", LATCHED)
        self.wait_for("the state and the features", lambda: states and features)
        self.assertEqual((states[0].state, states[0].why, states[0].header.frame_id),
                         (State.LOST, "a wall is all that is to be seen", "camera"))
        self.assertEqual(bytes(features[0].descriptors), bytes(range(1, 9)))
        self.assertEqual(list(features[0].keypoints), [1.0, 2.0, 0.5, 1.0])
        self.assertEqual((features[0].version, features[0].extractor), (Features.VERSION, "probe"))

    def logged(self, *words):
        """Whether a line of the probe's log has them all; ask from the start of a test on."""
        if not hasattr(self, "log"):
            self.log = self.collect(Log, "/rosout", QoSProfile(
                depth=100, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL))
        return any(line.name == "probe" and all(word in line.msg for word in words)
                   for line in self.log)

    def test_ends_that_do_not_fit_are_named(self):
        self.start()
        self.logged()
        self.node.create_publisher(Header, "faulty", BEST_EFFORT)
        self.wait_for("a warning", lambda: self.logged("publishes /faulty", "reliability"))
        self.collect(Image, "image_back", LATCHED)
        self.wait_for("a warning", lambda: self.logged("reads /image_back", "durability"))

    def test_images_of_a_best_effort_publisher_are_heard(self):
        self.start()
        self.logged()
        back = self.collect(Image, "image_back")
        publisher = self.node.create_publisher(Image, "image", BEST_EFFORT)
        small = Image(width=8, height=1, step=8, encoding="mono8", data=bytes(range(8)))

        def heard():
            publisher.publish(small)
            return back
        self.wait_for("an image", heard)
        self.assertEqual(bytes(back[0].data), bytes(range(8)))
        self.wait_for("a warning", lambda: self.logged("/image is published best effort"))

    def test_an_error_in_a_callback_costs_only_itself(self):
        self.start()
        self.logged()
        publisher = self.node.create_publisher(Header, "faulty", 10)

        def reported():
            publisher.publish(Header(frame_id="a wrong frame"))
            return self.logged("/faulty", "a wrong frame")
        self.wait_for("the error", reported)
        self.assertTrue(self.call(Trigger, "probe/count", Trigger.Request()).success)


class Services(RosTest):
    def test_answers(self):
        self.start()
        answer = self.call(SaveMap, "probe/save_map", SaveMap.Request(path="/tmp/a.map"))
        self.assertEqual((answer.success, answer.message), (True, "Saved to /tmp/a.map."))
        answer = self.call(SaveMap, "probe/save_map", SaveMap.Request())
        self.assertEqual((answer.success, answer.message), (False, "No path."))

    def test_an_error_is_answered_too(self):
        self.start()
        answer = self.call(Trigger, "probe/broken", Trigger.Request())
        self.assertEqual((answer.success, answer.message), (False, "begun"))
        self.assertTrue(self.call(SaveMap, "probe/save_map", SaveMap.Request(path="b")).success)

    def test_answers_later_from_another_thread(self):
        self.start()
        for number in (1, 2, 3):
            answer = self.call(Trigger, "probe/post", Trigger.Request())
            self.assertEqual((answer.success, answer.message), (True, str(number)))

    def test_a_dropped_answer_is_sent(self):
        self.start()
        answer = self.call(Trigger, "probe/drop", Trigger.Request())
        self.assertEqual((answer.success, answer.message), (False, "gone"))

    def test_counts_who_is_there(self):
        self.start()
        self.collect(Image, "image_back")
        first, second = (self.node.create_publisher(Image, "image", 10) for _ in range(2))
        self.wait_for("two publishers", lambda: self.counts() == "2 2 1 0 ")
        self.node.destroy_publisher(second)
        self.wait_for("one publisher", lambda: self.counts() == "1 1 1 0 ")


class Parameters(RosTest):
    def get(self, *names):
        return self.call(GetParameters, "probe/get_parameters",
                         GetParameters.Request(names=names)).values

    def set(self, **values):
        parameters = [Parameter(name.replace("__", "."), value=value).to_parameter_msg()
                      for name, value in values.items()]
        return self.call(SetParameters, "probe/set_parameters",
                         SetParameters.Request(parameters=parameters)).results

    def set_together(self, **values):
        parameters = [Parameter(name.replace("__", "."), value=value).to_parameter_msg()
                      for name, value in values.items()]
        return self.call(SetParametersAtomically, "probe/set_parameters_atomically",
                         SetParametersAtomically.Request(parameters=parameters)).result

    def test_reads(self):
        self.start()
        names = ["rate", "grid.levels", "mode", "use_sim_time", "weights", "unknown"]
        values = self.get(*names)
        self.assertEqual([value.type for value in values], [
            ParameterType.PARAMETER_DOUBLE, ParameterType.PARAMETER_INTEGER,
            ParameterType.PARAMETER_STRING, ParameterType.PARAMETER_BOOL,
            ParameterType.PARAMETER_DOUBLE_ARRAY, ParameterType.PARAMETER_NOT_SET])
        self.assertEqual((values[0].double_value, values[1].integer_value, values[2].string_value,
                          values[3].bool_value, list(values[4].double_array_value)),
                         (15.0, 4, "mapping", False, [1.0, 2.5]))
        types = self.call(GetParameterTypes, "probe/get_parameter_types",
                          GetParameterTypes.Request(names=names)).types
        self.assertEqual(list(types), [value.type for value in values])

    def test_lists(self):
        self.start()

        def listed(**request):
            result = self.call(ListParameters, "probe/list_parameters",
                               ListParameters.Request(**request)).result
            return sorted(result.names), list(result.prefixes)
        top = ["frame", "mode", "rate", "use_sim_time", "weights"]
        self.assertEqual(listed(), (sorted([*top, "grid.levels"]), ["grid"]))
        self.assertEqual(listed(depth=1), (top, []))
        self.assertEqual(listed(prefixes=["grid"]), (["grid.levels"], ["grid"]))

    def test_describes(self):
        self.start()
        rate, levels, mode, frame, unknown = self.call(
            DescribeParameters, "probe/describe_parameters", DescribeParameters.Request(
                names=["rate", "grid.levels", "mode", "frame", "unknown"])).descriptors
        self.assertEqual((rate.name, rate.description, rate.read_only),
                         ("rate", "Poses per second.", False))
        self.assertEqual((rate.floating_point_range[0].from_value,
                          rate.floating_point_range[0].to_value), (0.5, 60.0))
        self.assertEqual((levels.integer_range[0].from_value, levels.integer_range[0].to_value,
                          levels.integer_range[0].step), (2, 10, 2))
        self.assertEqual(mode.additional_constraints, "mapping or localization")
        self.assertTrue(frame.read_only)
        self.assertEqual((unknown.name, unknown.type), ("unknown", ParameterType.PARAMETER_NOT_SET))

    def test_sets_and_tells(self):
        self.start()
        events = self.collect(ParameterEvent, "/parameter_events", 100)
        self.wait_for("events", lambda: self.set(rate=10.0) and self.changes(events))
        told = len(self.changes(events))
        results = self.set(rate=20.0, grid__levels=6, mode="localization")
        self.assertEqual([result.successful for result in results], [True] * 3)
        values = self.get("rate", "grid.levels", "mode")
        self.assertEqual((values[0].double_value, values[1].integer_value, values[2].string_value),
                         (20.0, 6, "localization"))
        self.assertTrue(self.set(rate=30)[0].successful, "a whole number is a number")
        self.assertEqual(self.get("rate")[0].double_value, 30.0)
        self.wait_for("four events", lambda: len(self.changes(events)) >= told + 4)
        self.assertEqual(
            [(name, value.double_value) for name, value in self.changes(events)][-1], ("rate", 30.0))
        self.assertEqual([name for name, _ in self.changes(events)][-4:],
                         ["rate", "grid.levels", "mode", "rate"])

    @staticmethod
    def changes(events):
        return [(parameter.name, parameter.value) for event in events if event.node == "/probe"
                for parameter in event.changed_parameters]

    def test_refuses_with_a_sentence(self):
        self.start()
        for values, sentence in [
                ({"rate": 100.0}, "rate is 0.5 to 60, not 100."),
                ({"rate": float("nan")}, "rate is 0.5 to 60, not nan."),
                ({"rate": "fast"}, "rate is a number, not a text."),
                ({"grid__levels": 3}, "grid.levels is 2 to 10 in steps of 2, not 3."),
                ({"grid__levels": 4.0}, "grid.levels is a whole number, not a number."),
                ({"mode": "sleep"}, "mode is mapping or localization, not 'sleep'."),
                ({"frame": "other"}, "frame can be given at the start of the node alone."),
                ({"unknown": 1}, "There is no parameter unknown.")]:
            with self.subTest(values=values):
                result, = self.set(**values)
                self.assertEqual((result.successful, result.reason), (False, sentence))
        self.assertEqual(self.get("rate")[0].double_value, 15.0)

    def test_sets_all_or_none(self):
        self.start()
        result = self.set_together(mode="localization", rate=100.0)
        self.assertEqual((result.successful, result.reason), (False, "rate is 0.5 to 60, not 100."))
        result = self.set_together(rate=0.5, grid__levels=10)
        self.assertEqual((result.successful, result.reason),
                         (False, "A rate below 1 goes with at most 8 levels."))
        values = self.get("mode", "rate", "grid.levels")
        self.assertEqual((values[0].string_value, values[1].double_value, values[2].integer_value),
                         ("mapping", 15.0, 4))
        self.assertTrue(self.set_together(mode="localization", rate=1.0).successful)
        self.assertEqual(self.get("mode")[0].string_value, "localization")


class Start(RosTest):
    """What the command line says."""

    def refused(self, *arguments):
        run = subprocess.run([PROBE, "--ros-args", *arguments], stderr=subprocess.PIPE, text=True,
                             timeout=PATIENCE)
        self.assertEqual(run.returncode, 1, run.stderr)
        return run.stderr

    def test_names_in_the_graph(self):
        self.start("--ros-args", "-r", "__ns:=/robot", "-r", "__node:=slam",
                   "-r", "image:=/camera/color/image_raw", "-r", "probe:~/state:=unused")
        self.wait_for("the node", lambda: "/robot/slam" in self.nodes())
        topics = {}

        def seen():
            topics.update(dict(self.node.get_topic_names_and_types()))
            return "/robot/slam/ticks" in topics and "/camera/color/image_raw" in topics
        self.wait_for("its topics", seen)
        self.assertEqual(topics["/camera/color/image_raw"], ["sensor_msgs/msg/Image"])
        self.assertEqual(topics["/tf"], ["tf2_msgs/msg/TFMessage"])
        self.assertNotIn("/image", topics)
        services = dict(self.node.get_service_names_and_types_by_node("slam", "/robot"))
        self.assertEqual(services["/robot/slam/save_map"], ["dxslam_msgs/srv/SaveMap"])
        for name in ("describe_parameters", "get_parameter_types", "get_parameters",
                     "list_parameters", "set_parameters", "set_parameters_atomically"):
            self.assertIn(f"/robot/slam/{name}", services)
        publishers = self.node.get_publishers_info_by_topic("/robot/slam/state")
        self.assertEqual([(one.node_name, one.node_namespace) for one in publishers],
                         [("slam", "/robot")])
        self.assertEqual(publishers[0].qos_profile.durability, QoSDurabilityPolicy.TRANSIENT_LOCAL)

    def test_parameters_of_files_and_options(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "parameters.yaml"
            file.write_text("/**:\n  ros__parameters: {rate: 5.0, mode: localization}\n"
                            "/robot/probe:\n  ros__parameters: {grid: {levels: 8}, rate: 7}\n"
                            "/*/probe:\n  ros__parameters: {weights: [4.0, 5.0]}\n"
                            "/other:\n  ros__parameters: {mode: sleep}\n"
                            "/*:\n  ros__parameters: {mode: sleep}\n")
            self.start("--ros-args", "-r", "__ns:=/robot", "--params-file", str(file),
                       "-p", "frame:=optical")
            values = self.call(
                GetParameters, "/robot/probe/get_parameters", GetParameters.Request(
                    names=["rate", "mode", "grid.levels", "frame", "weights"])).values
        self.assertEqual((values[0].double_value, values[1].string_value, values[2].integer_value,
                          values[3].string_value, list(values[4].double_array_value)),
                         (7.0, "localization", 8, "optical", [4.0, 5.0]))

    def test_bad_starts_are_refused_in_a_sentence(self):
        self.assertIn("probe: rate is 0.5 to 60, not 100.\n", self.refused("-p", "rate:=100.0"))
        self.assertIn("probe: mode is a text, not true or false.\n", self.refused("-p", "mode:=true"))
        self.assertIn("probe: what follows --ros-args cannot be read: ",
                      self.refused("--params-file", "/nowhere/file.yaml"))
        self.assertIn("'--nonsense' after --ros-args is no argument", self.refused("--nonsense"))
        self.assertIn("probe: ", self.refused("-r", "__node:=a b"))

    def test_what_is_not_for_ros_is_left(self):
        probe = self.start("one", "--ros-args", "-p", "unknown:=1", "--", "two")
        self.wait_for("the node", lambda: "/probe" in self.nodes())
        probe.send_signal(signal.SIGINT)
        _, errors = probe.communicate(timeout=PATIENCE)
        self.assertIn("argument one\nargument two\n", errors)
        self.assertIn("There is no parameter unknown.", errors)


class SimulatedTime(RosTest):
    def test_the_clock_of_a_simulation(self):
        self.start("--ros-args", "-p", "use_sim_time:=true")
        ticks = self.collect(Header, "probe/ticks", 100)
        clock = self.node.create_publisher(Clock, "/clock", 10)
        self.wait_for("both", lambda: clock.get_subscription_count() == 1 and
                      self.node.count_publishers("probe/ticks") == 1)
        now = 1000.0

        def step():
            nonlocal now
            now += 0.02
            clock.publish(Clock(clock=Time(sec=int(now), nanosec=int(now % 1 * 1e9))))
            return len(ticks) >= 5
        self.wait_for("five ticks", step)
        stamps = [tick.stamp.sec + tick.stamp.nanosec * 1e-9 for tick in ticks]
        self.assertGreaterEqual(min(stamps), 1000.0)
        self.assertLessEqual(max(stamps), now)
        # Nothing ticks while the simulation stands still.
        for _ in range(10):
            self.executor.spin_once(0.05)
        count = len(ticks)
        for _ in range(20):
            self.executor.spin_once(0.05)
        self.assertEqual(len(ticks), count)

    def test_it_can_be_switched_on_later(self):
        self.start()
        ticks = self.collect(Header, "probe/ticks", 100)
        self.wait_for("a tick of today", lambda: ticks and ticks[-1].stamp.sec > 1_600_000_000)
        parameter = Parameter("use_sim_time", value=True).to_parameter_msg()
        result, = self.call(SetParameters, "probe/set_parameters",
                            SetParameters.Request(parameters=[parameter])).results
        self.assertTrue(result.successful)
        clock = self.node.create_publisher(Clock, "/clock", 10)
        now = 50.0

        def step():
            nonlocal now
            now += 0.05
            clock.publish(Clock(clock=Time(sec=int(now), nanosec=0)))
            return ticks[-1].stamp.sec < 1000 and ticks[-1].stamp.sec >= 50
        self.wait_for("a tick of the simulation", step)


class Ends(RosTest):
    @classmethod
    def tearDownClass(cls):
        """What was killed leaves 16 MB of shared memory each; this removes what nobody uses."""
        tool = Path(sys.prefix) / "tools" / "fastdds" / "fastdds.py"
        subprocess.run([sys.executable, tool, "shm", "clean"], stdout=subprocess.DEVNULL, check=True)

    def test_signals(self):
        """A stopped program ends by itself, within 2 s (5 for busy machines)."""
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(signal=number.name):
                probe = self.start()
                self.wait_for("the node", lambda: "/probe" in self.nodes())
                probe.send_signal(number)
                _, errors = probe.communicate(timeout=5)
                self.assertEqual((probe.returncode, errors.splitlines()[-1]), (0, "ended"))
                self.wait_for("the node's end", lambda: "/probe" not in self.nodes())

    def test_an_ignored_signal_has_no_effect(self):
        probe = self.start(preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN))
        self.wait_for("the node", lambda: "/probe" in self.nodes())
        probe.send_signal(signal.SIGINT)
        self.assertTrue(self.call(Trigger, "probe/post", Trigger.Request()).success)
        self.assertTrue(self.call(Trigger, "probe/post", Trigger.Request()).success)

    def test_a_killed_node_can_come_back(self):
        publisher = self.node.create_publisher(Image, "image", 100)
        back = self.collect(Image, "image_back", 100)
        for number in range(2):
            probe = self.start()
            message = image(number)

            def again():
                publisher.publish(message)
                return back and back[-1].data == message.data
            self.wait_for(f"image {number}", again)
            probe.kill()
            probe.wait()

    def test_a_killed_peer_can_come_back(self):
        self.start()
        program = ("import sys, rclpy\nfrom sensor_msgs.msg import Image\nrclpy.init()\n"
                   "node = rclpy.create_node('peer')\nreceived = []\n"
                   "node.create_subscription(Image, 'image_back', received.append, 10)\n"
                   "publisher = node.create_publisher(Image, 'image', 10)\n"
                   "while not received:\n"
                   "    publisher.publish(Image(height=int(sys.argv[1])))\n"
                   "    rclpy.spin_once(node, timeout_sec=0.05)\n"
                   "print('got', received[-1].height, flush=True)\n"
                   "while True:\n    publisher.publish(Image(height=int(sys.argv[1])))\n")
        for height in (11, 12):
            with subprocess.Popen([sys.executable, "-c", program, str(height)],
                                  stdout=subprocess.PIPE, text=True) as peer:
                self.assertEqual(peer.stdout.readline(), f"got {height}\n")
                peer.kill()
        self.assertTrue(self.call(Trigger, "probe/post", Trigger.Request()).success)


if __name__ == "__main__":
    unittest.main()
