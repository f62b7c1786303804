#!/usr/bin/env python3
"""Velocities for a simulated robot, for teams with a controller of their own: blue robot 0 drives a circle.

    onetwo simulate
    python3 host/team/examples/velocities.py [ROBOT] [HOST] [PORT]

The league's simulation protocol by UDP, 10301 blue and 10302 yellow, with the standard library alone; numbers of
fields as in ssl_simulation_robot_control.proto. A robot without a command for 0.1 s stops; Ctrl-C ends it.
"""
import socket
import struct
import sys
import time


def message(number, content):
    return bytes([number << 3 | 2, len(content)]) + content


def command(robot, forward, left, angular):
    """RobotControl for a robot, 0 to 15, by its own axes: m/s ahead, m/s to its left, rad/s counter-clockwise."""
    speeds = b"".join(struct.pack("<Bf", number << 3 | 5, speed) for number, speed in enumerate((forward, left, angular), 1))
    return message(1, struct.pack("BB", 1 << 3, robot) + message(2, message(2, speeds)))


robot, host, port = (sys.argv[1:] + ["0", "127.0.0.1", "10301"][len(sys.argv) - 1 :])[:3]
link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
while True:
    link.sendto(command(int(robot), 1.0, 0.0, 2.0), (host, int(port)))
    time.sleep(1 / 60)
