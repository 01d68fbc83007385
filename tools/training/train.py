#!/usr/bin/env python3
"""Trains esi_net on the samples of make_samples and writes esi/esi_net_weights.cc.

    make_samples 1 300 DIR                      # some 10 minutes on two cores
    python3 train.py DIR esi/esi_net_weights.cc # some 15 minutes on one

Needs Debian's python3-torch and python3-numpy. The last tenth of the seeds is kept back
to judge by. The same samples, seed and build of torch give the same weights.
"""

import argparse
import pathlib
import time

import numpy as np
import torch
from torch import nn
from torch.nn import functional as F

FEATURES = 8  # kPixelFeatures
HIDDEN = 16  # kConvolutionOut
LAYERS = 3
ONE = 512  # kFeatureOne
WEIGHT_BITS = 12  # kEsiNetWeightBits
MOST_VALUE = 8191  # kMostValue
PATCH = 96


def load(folder):
    """All patches by seed: features (n, 32, 48, 48) as int16, truth (n, 1, 96, 96)."""
    features, truth, seeds = [], [], []
    for path in sorted(pathlib.Path(folder).glob("*.features"), key=lambda p: int(p.stem)):
        x = np.fromfile(path, np.int16).reshape(-1, PATCH // 2, PATCH // 2, 4 * FEATURES)
        y = np.fromfile(path.with_suffix(".truth"), np.float32).reshape(-1, 1, PATCH, PATCH)
        features.append(x)
        truth.append(y.astype(np.float16))
        seeds += [int(path.stem)] * len(x)
    return np.concatenate(features), np.concatenate(truth), np.array(seeds)


class Network(nn.Module):
    """3x3 layers; the last one also sees the features themselves, for sharp edges."""

    def __init__(self):
        super().__init__()
        channels = [4 * FEATURES] + [HIDDEN] * LAYERS
        self.layers = nn.ModuleList(
            nn.Conv2d(a, b, 3, padding=1) for a, b in zip(channels, channels[1:]))
        self.output = nn.Conv2d(HIDDEN + 4 * FEATURES, 4, 1)

    def forward(self, features):
        hidden = features
        for layer in self.layers:
            hidden = F.relu(layer(hidden))
        return self.output(torch.cat([hidden, features], 1))


def see(network, features):
    """Features as they are stored -> pictures (n, 1, 96, 96), in deviations."""
    return F.pixel_shuffle(network(features.permute(0, 3, 1, 2).float() / ONE), 2)


WINDOW = torch.tensor(np.exp(-((np.arange(11) - 5) ** 2) / (2 * 1.5**2)), dtype=torch.float32)
WINDOW /= WINDOW.sum()


def blur(x):
    return F.conv2d(F.conv2d(x, WINDOW.view(1, 1, 1, -1)), WINDOW.view(1, 1, -1, 1))


def slopes(x):
    return x[:, :, :, 1:] - x[:, :, :, :-1], x[:, :, 1:] - x[:, :, :-1]


def loss(picture, truth):
    """1 - SSIM, plus how far grey and its slopes are off: against the truth in deviations."""
    mean = truth.mean((2, 3), keepdim=True)
    deviation = truth.std((2, 3), unbiased=False, keepdim=True).clamp(min=0.15)
    x = (picture - picture.mean((2, 3), keepdim=True)) / 4
    y = (truth - mean) / deviation / 4
    mx, my = blur(x), blur(y)
    xx, yy, xy = blur(x * x) - mx * mx, blur(y * y) - my * my, blur(x * y) - mx * my
    c1, c2 = 1e-4, 9e-4
    ssim = (2 * mx * my + c1) * (2 * xy + c2) / ((mx * mx + my * my + c1) * (xx + yy + c2))
    edges = sum((a - b).abs().mean() for a, b in zip(slopes(x), slopes(y)))
    # The mean over a patch is free, but not to wander off the middle grey.
    anchor = 0.1 * picture.mean((1, 2, 3)).square().mean()
    return 1 - ssim.mean() + 4 * (x - y).abs().mean() + 8 * edges + anchor


def turned(x, y, quarter_turns, mirrored):
    """The same patch from another side: blocks, the pixels within them, and the truth."""
    n, h, w, _ = x.shape
    full = F.pixel_shuffle(
        x.view(n, h, w, 4, FEATURES).permute(0, 4, 3, 1, 2).reshape(n, 4 * FEATURES, h, w), 2)
    full, y = torch.rot90(full, quarter_turns, (2, 3)), torch.rot90(y, quarter_turns, (2, 3))
    if mirrored:
        full, y = full.flip(3), y.flip(3)
    blocks = F.pixel_unshuffle(full, 2).view(n, FEATURES, 4, h, w).permute(0, 3, 4, 2, 1)
    return blocks.reshape(n, h, w, 4 * FEATURES), y


def judge(network, x, y):
    network.eval()
    with torch.no_grad():
        losses = [loss(see(network, x[i:i + 16]), y[i:i + 16].float()).item() * len(x[i:i + 16])
                  for i in range(0, len(x), 16)]
    network.train()
    return sum(losses) / len(x)


def train(network, x, y, steps, batch, rate, seed):
    random = np.random.default_rng(seed)
    optimiser = torch.optim.Adam(network.parameters(), lr=rate)
    start, total = time.time(), 0.0
    for step in range(1, steps + 1):
        for group in optimiser.param_groups:  # warm up, then a cosine down to nearly nothing
            group["lr"] = rate * min(1, step / 100) * (0.51 + 0.5 * np.cos(np.pi * step / steps))
        chosen = random.integers(0, len(x), batch)
        a, b = turned(x[chosen].float(), y[chosen].float(), int(random.integers(0, 4)),
                      bool(random.integers(0, 2)))
        value = loss(see(network, a), b)
        optimiser.zero_grad()
        value.backward()
        nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        optimiser.step()
        total += value.item()
        if step % 200 == 0:
            left_s = (time.time() - start) / step * (steps - step)
            print(f"step {step} of {steps}: loss {total / 200:.4f}, {left_s:.0f} s left", flush=True)
            total = 0.0


def whole(values, most):
    rounded = np.rint(values).astype(np.int64)
    if np.abs(rounded).max() > most:
        raise SystemExit(f"a weight of {np.abs(rounded).max()}, allowed {most}")
    return rounded


def listed(name, kind, values):
    lines, line = [], "   "
    for value in values.reshape(-1):
        if len(line) + len(str(value)) + 2 > 99:
            lines.append(line)
            line = "   "
        line += f" {value},"
    return f"constexpr std::{kind} {name}[] = {{\n" + "\n".join([*lines, line]) + "\n};\n"


def write(network, path):
    """The weights as whole numbers, in the order esi/small_convolution.h wants them."""
    parts, layers = [], ""
    for i, m in enumerate(network.layers):
        weight = m.weight.detach().numpy().astype(np.float64)
        channels = weight.shape[1]
        w = whole(weight * 2**WEIGHT_BITS, 32767)
        b = whole(m.bias.detach().numpy().astype(np.float64) * 2**WEIGHT_BITS * ONE, 2**31 - 1)
        most_in = MOST_VALUE if i > 0 else 3 * ONE
        if np.abs(w).sum((1, 2, 3)).max() * most_in + np.abs(b).max() >= 2**31:
            raise SystemExit(f"layer {i} can exceed 32 bits")
        pairs = w.transpose(2, 3, 1, 0).reshape(3, 3, channels // 2, 2, HIDDEN)
        parts += [listed(f"kWeights{i}", "int16_t", pairs.transpose(0, 1, 2, 4, 3)),
                  listed(f"kBias{i}", "int32_t", b)]
        layers += f"      {{{channels}, kWeights{i}, kBias{i}, kEsiNetWeightBits}},\n"
    last = network.output
    scale = 2**WEIGHT_BITS
    parts += [listed("kOutput", "int16_t",
                     whole(last.weight.detach().numpy()[:, :, 0, 0] * scale, 32767)),
              listed("kOutputBias", "int32_t",
                     whole(last.bias.detach().numpy().astype(np.float64) * scale * ONE, 2**31 - 1))]
    pathlib.Path(path).write_text(f"""// Written by tools/training/train.py; do not edit.
#include "esi/esi_net_weights.h"

namespace nightjar::esi {{
namespace {{

// clang-format off
{"".join(parts)}// clang-format on

}}  // namespace

std::span<const Convolution> esi_net_layers() {{
  static const Convolution layers[] = {{
{layers}  }};
  return layers;
}}

std::span<const std::int16_t, 4 * kEsiNetOutputIn> esi_net_output() {{ return kOutput; }}

std::span<const std::int32_t, 4> esi_net_output_bias() {{ return kOutputBias; }}

}}  // namespace nightjar::esi
""")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("samples", help="the folder that make_samples filled")
    parser.add_argument("out", help="the C++ file to write")
    parser.add_argument("--steps", type=int, default=18000)
    parser.add_argument("--batch", type=int, default=8)
    parser.add_argument("--rate", type=float, default=2e-3)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()

    torch.set_num_threads(1)  # more would also sum in another order
    torch.manual_seed(arguments.seed)
    features, truth, seeds = load(arguments.samples)
    every = np.unique(seeds)
    known = ~np.isin(seeds, every[-max(1, len(every) // 10):])
    x, y = torch.from_numpy(features), torch.from_numpy(truth)
    network = Network()
    print(f"{known.sum()} patches to learn from, {(~known).sum()} to judge by, "
          f"{sum(p.numel() for p in network.parameters())} weights", flush=True)
    train(network, x[known], y[known], arguments.steps, arguments.batch, arguments.rate,
          arguments.seed)
    print(f"loss on the patches kept back: {judge(network, x[~known], y[~known]):.4f}")
    write(network, arguments.out)


if __name__ == "__main__":
    main()
