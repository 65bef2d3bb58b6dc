#!/usr/bin/env python3
"""How well the ROS node keeps up: messages lost, latency of a command, fastest flight, lockstep.

Build a workspace with -DQUADCORE_BUILD_BENCHMARKS=ON and source its setup.bash first. Options:
``ros_latency.py [SECONDS [SAMPLES]]``, 60 s of odometry and 1000 commands by default.
"""

import os
import shutil
import socket
import subprocess
import sys
import time
from contextlib import ExitStack, contextmanager
from statistics import median

import roslib.packages

from quadcore.model.description import load_description

SECONDS = float(sys.argv[1]) if len(sys.argv) > 1 else 60
SAMPLES = int(sys.argv[2]) if len(sys.argv) > 2 else 1000


@contextmanager
def running(*command):
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


def executable(name):
    found = roslib.packages.find_node("quadcore", name)
    if not found:
        sys.exit(f"{name} is not built: catkin_make -DQUADCORE_BUILD_BENCHMARKS=ON")
    return found[0]


def probe(*arguments):
    command = [executable("ros_probe"), *map(str, arguments)]
    return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout


@contextmanager
def node(model, *arguments):
    with running(executable("quadcore_node"), f"_model:={model}", "_z:=1000", *arguments):
        time.sleep(1)
        yield


def main():
    with socket.socket() as free:
        free.bind(("localhost", 0))
        port = free.getsockname()[1]
    os.environ["ROS_MASTER_URI"] = f"http://localhost:{port}"
    folder = os.path.join("/tmp", f"ros_latency.{os.getpid()}")
    os.mkdir(folder)
    model = os.path.join(folder, "quadrotor.urdf")
    with open(model, "w") as file:
        file.write(load_description("quadrotor", {"sim_slow": "1"}).text)
    with ExitStack() as stack:
        stack.callback(shutil.rmtree, folder)
        stack.enter_context(running("rosmaster", "--core", "-p", str(port)))
        time.sleep(1)

        with node(model):
            count, lost, simulated, elapsed, *late = map(float, probe("count", SECONDS).split())
            print(f"real-time factor 1 for {elapsed:.0f} s: {count / elapsed:.1f} odometry per s")
            print(f"    lost                     {lost:9.0f}   none")
            print(f"    real-time factor         {simulated / elapsed:9.4f}")
            print("odometry after its time of simulation, from the earliest message on, us:")
            print(f"    median                   {late[0]:9.0f}   below 150")
            print(f"    99 of 100 within         {late[1]:9.0f}   1000")
            print(f"    longest                  {late[2]:9.0f}")
            samples = sorted(float(line) for line in probe("latency", SAMPLES).split())
            print(f"vel_cmd to the odometry that reflects it, {len(samples)} commands, us:")
            print(f"    median                   {median(samples):9.0f}   below 1200")
            print(f"    99 of 100 within         {samples[len(samples) * 99 // 100]:9.0f}")
            print(f"    longest                  {samples[-1]:9.0f}")
        with node(model, "_real_time_factor:=0"):
            count, lost, simulated, elapsed, *_ = map(float, probe("count", 5).split())
            print(f"as fast as possible, odometry at every step: {count / elapsed:.0f} per s")
            print(f"    real-time factor         {simulated / elapsed:9.1f}   at least 20")
            print(f"    lost                     {lost:9.0f}")
        with node(model, "_real_time_factor:=0", "_lockstep:=true"):
            count, _, simulated, elapsed, *_ = map(float, probe("answer", 5).split())
        with running(executable("ros_probe"), "echo", "8"):
            exchanges, bare = map(float, probe("ask", 5).split())
        print(f"in lockstep, a roscpp node answers each step: {count / elapsed:.0f} per s")
        print(f"    real-time factor         {simulated / elapsed:9.1f}   at least 20")
        print(f"two roscpp nodes without a simulator: {exchanges / bare:.0f} exchanges per s")
        print(f"    lockstep over that       {count / elapsed / (exchanges / bare):9.2f}")


main()
