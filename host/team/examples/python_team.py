#!/usr/bin/env python3
"""A team in Python with the standard library alone: the nearest robot shoots where the goal is open, and passes
to the teammate that is freest where it is not; the others do what onetwo's coach orders.

    onetwo play --blue-strategy "python3 host/team/examples/python_team.py"

Lines of JSON, attack frame (docs/strategy-protocol.md): we attack towards +x; m, m/s, rad.
"""

import json
import math
import sys


def clear(start, end, theirs, radius=0.15):
    """Whether no opponent stands within `radius` of the straight way from `start` to `end`."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = math.hypot(dx, dy)
    for x, y in (robot["at"] for robot in theirs):
        along = min(max(((x - start[0]) * dx + (y - start[1]) * dy) / max(length, 1e-6), 0.1), length)
        if math.hypot(start[0] + dx / max(length, 1e-6) * along - x, start[1] + dy / max(length, 1e-6) * along - y) < radius:
            return False
    return True


def answer(view, state):
    orders, draw, ball = [], [], view["ball"]
    players = [robot for robot in view["ours"] if robot["robot"] not in [view["keeper"], *view["bound"]]]
    half, depth = view["field"]["length"] / 2, view["field"]["area_depth"]
    # Restarts and stoppages are the coach's, and a ball in our own area is the keeper's.
    if view["phase"]["name"] != "run" or not ball or not players or ball["at"][0] < depth - half:
        return {"orders": []}
    # Who goes to the ball goes on, unless another is nearer by a robot's length.
    distance = lambda robot: math.dist(robot["at"], ball["at"]) - (0.18 if robot["robot"] == state.get("had") else 0)
    passer = min(players, key=distance)
    state["had"] = passer["robot"]
    posts = [view["field"]["goal_width"] * share for share in (-0.4, -0.2, 0.0, 0.2, 0.4)]
    open_points = [[half, y] for y in posts if clear(ball["at"], [half, y], view["theirs"])]
    mates = [robot for robot in players if robot is not passer and robot["at"][0] > ball["at"][0] - 1.0]
    free = [mate for mate in mates if clear(ball["at"], mate["at"], view["theirs"], 0.25)]
    if open_points or not free:
        target = open_points[len(open_points) // 2] if open_points else [half, 0.0]
        orders.append({"robot": passer["robot"], "task": {"kick": {"at": target, "speed": 6.0}}})
    else:
        mate = max(free, key=lambda robot: robot["at"][0])
        target = mate["at"]
        speed = min(max(3.0 + 0.5 * math.dist(ball["at"], target), 3.0), 5.5)
        orders.append({"robot": passer["robot"], "task": {"pass": {"at": target, "receiver": mate["robot"], "speed": speed}}})
        orders.append({"robot": mate["robot"], "task": {"receive": {"at": target, "then": [half, 0.0]}}})
    draw.append({"line": {"from": ball["at"], "to": target, "arrow": True}})
    return {"orders": orders, "draw": draw, "values": {"open points": len(open_points)}}


def main():
    state = {}
    for line in sys.stdin:
        print(json.dumps(answer(json.loads(line), state)), flush=True)


if __name__ == "__main__":
    main()
