"""A tree search of 1,000 nodes on saved states: where to shoot at the keeper.

`python host/python/examples/tree_search.py [SEED]`. Each node is a saved state; an edge plays one of five orders for 0.2 s.
The node with the best return so far is expanded next; the plan found is then played in an environment of its own.
"""

from __future__ import annotations

import heapq
import itertools
import sys
import time

import onetwo

Plan = list[list[float]]
NODES = 1_000
PERIODS = 8  # of 25 ms: an edge
# Forward, left, turn, kick, dribbler: approach, turn either way with the ball, shoot, shoot on the move.
ORDERS: Plan = [[0.3, 0, 0, 0, 1], [0.05, 0, 0.15, 0, 1], [0.05, 0, -0.15, 0, 1], [0.1, 0, 0, 0.9, 0], [0.4, 0.1, 0, 0.9, 0]]


def play(simulator: onetwo.Simulator, order: list[float]) -> tuple[float, str | None]:
    """The sum of rewards of an edge, and the end of the episode if it came."""
    total, end = 0.0, None
    for _ in range(PERIODS):
        reward, end = simulator.step(order)
        total += reward
        if end is not None:
            break
    return total, end


def search(simulator: onetwo.Simulator, nodes: int) -> tuple[float, Plan]:
    """The best return within so many nodes, and the orders that lead to it."""
    count = itertools.count()
    queue: list[tuple[float, int, Plan, bytes]] = [(0.0, next(count), [], simulator.save())]
    best: tuple[float, Plan] = (0.0, [])
    made = 0
    while queue and made < nodes:
        loss, _, plan, state = heapq.heappop(queue)
        for order in ORDERS:
            simulator.restore(state)
            reward, end = play(simulator, order)
            found = (reward - loss, [*plan, order])
            best = max(best, found, key=lambda one: one[0])
            made += 1
            if end is None:
                heapq.heappush(queue, (-found[0], next(count), found[1], simulator.save()))
    return best


def main() -> None:
    seed = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    simulator = onetwo.Simulator(task="shoot-at-keeper", seed=seed)
    began = time.perf_counter()
    expected, plan = search(simulator, NODES)
    seconds = time.perf_counter() - began
    simulator.reset(seed)
    played = [play(simulator, order) for order in plan]
    total, end = sum(reward for reward, _ in played), played[-1][1] if played else None
    print(f"{NODES} nodes in {seconds:.2f} s: a plan of {len(plan)} orders, return {expected:.3f}; played: {total:.3f}, {end}")


if __name__ == "__main__":
    main()
