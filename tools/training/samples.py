"""The patches of make_samples, scene by scene."""

import pathlib

import numpy as np
import torch
from torch.nn import functional as F

from network import FEATURES

PATCH = 192


def scenes(folder):
    """Seed, features (n, 96, 96, 32) as int16 and truth (n, 1, 192, 192) of each scene, in the
    order of their seeds."""
    finished = (p for p in pathlib.Path(folder).glob("*.truth") if p.stem.isdigit())
    for path in sorted(finished, key=lambda p: int(p.stem)):
        if path.stat().st_size == 0:
            continue
        features = np.memmap(path.with_suffix(".features"), np.int16, "r")
        truth = np.memmap(path, np.float32, "r")
        yield (int(path.stem), features.reshape(-1, PATCH // 2, PATCH // 2, 4 * FEATURES),
               truth.reshape(-1, 1, PATCH, PATCH))


def kept_back(seeds):
    """Which of the scenes are to judge by: each tenth."""
    return np.asarray(seeds) % 10 == 0


def turned(x, y, quarter_turns, mirrored):
    """The same patches from another side: blocks, the pixels within them, and the truth."""
    n, h, w, _ = x.shape
    full = F.pixel_shuffle(
        x.view(n, h, w, 4, FEATURES).permute(0, 4, 3, 1, 2).reshape(n, 4 * FEATURES, h, w), 2)
    full, y = torch.rot90(full, quarter_turns, (2, 3)), torch.rot90(y, quarter_turns, (2, 3))
    if mirrored:
        full, y = full.flip(3), y.flip(3)
    blocks = F.pixel_unshuffle(full, 2).view(n, FEATURES, 4, h, w).permute(0, 3, 4, 2, 1)
    return blocks.reshape(n, h, w, 4 * FEATURES), y


def turned_any_way(x, y, random):
    return turned(x, y, int(random.integers(0, 4)), bool(random.integers(0, 2)))
