"""States of environments as bytes: their random generators' states beside those of the simulator."""

from __future__ import annotations

import json
import zlib
from collections.abc import Sequence

import numpy as np

_MARK = b"onetwo env 1\n"
_HEAD = len(_MARK) + 8


def pack(generators: Sequence[np.random.Generator], simulator: bytes) -> bytes:
    """The bytes of an environment: mark, checksum and length of the generators' states, these as JSON, simulator."""
    states = json.dumps([generator.bit_generator.state for generator in generators]).encode()
    return _MARK + zlib.crc32(states).to_bytes(4, "little") + len(states).to_bytes(4, "little") + states + simulator


def unpack(state: bytes, count: int) -> tuple[list[np.random.Generator], bytes]:
    """What `pack` was given; `count` generators. Raises ValueError for other bytes."""
    if not isinstance(state, bytes) or not state.startswith(_MARK) or len(state) < _HEAD:
        raise ValueError("state: these bytes are no saved environment; take those that save() returned")
    length = int.from_bytes(state[_HEAD - 4 : _HEAD], "little")
    states, simulator = state[_HEAD : _HEAD + length], state[_HEAD + length :]
    if zlib.crc32(states).to_bytes(4, "little") != state[len(_MARK) : _HEAD - 4]:
        raise ValueError("state: damaged: its bytes differ from those that were saved")
    found = json.loads(states)
    if len(found) != count:
        raise ValueError(f"state: of {len(found)} random generators; this environment has {count}")
    generators = []
    for one in found:
        generator = np.random.Generator(np.random.PCG64())
        generator.bit_generator.state = one
        generators.append(generator)
    return generators, simulator
