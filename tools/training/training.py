"""What both trainings do alike."""

import argparse
import time

import numpy as np
import torch
from torch import nn
from torch.optim.swa_utils import AveragedModel

MOST_WEIGHT = 7.99  # what 16 bits hold at weights_file.WEIGHT_BITS below 1
WHITE = 3  # deviations that a picture's white comes near to


def shown(luminance):
    """What a picture is to show (n, 1, h, w): luminance's deviations, squeezed above the mean, of
    mean 0. Events count its logarithm; in luminance itself a white cell of a tag that comes out a
    little too dark is nearer to black than to the white margin, and is read as black."""
    mean = luminance.mean((2, 3), keepdim=True)
    deviation = luminance.std((2, 3), unbiased=False, keepdim=True) / mean
    y = (luminance / mean - 1) / deviation.clamp(min=0.15)
    y = y / (1 + y.clamp(min=0) / WHITE)
    return y - y.mean((2, 3), keepdim=True)


def train(network, draw_loss, judge, arguments):
    """Adam at one rate. `draw_loss()` gives a batch's loss, `judge(network)` what to say of a
    network every 500 steps. Returns the mean of what the network was in the last half of the
    steps, which does better than any one of them."""
    optimiser = torch.optim.Adam(network.parameters())
    average = AveragedModel(network)
    start, total = time.time(), 0.0
    for step in range(1, arguments.steps + 1):
        for group in optimiser.param_groups:
            group["lr"] = arguments.rate * min(1, step / 200)
        value = draw_loss()
        optimiser.zero_grad()
        value.backward()
        nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        optimiser.step()
        with torch.no_grad():
            for parameter in network.parameters():
                parameter.clamp_(-MOST_WEIGHT, MOST_WEIGHT)
        if step > arguments.steps // 2:
            average.update_parameters(network)
        total += value.item()
        if step % 500 == 0:
            judged = judge(average.module if step > arguments.steps // 2 else network)
            left_s = (time.time() - start) / step * (arguments.steps - step)
            print(f"step {step} of {arguments.steps}: loss {total / 500:.4f}, {judged:.4f} on what "
                  f"is kept back, {left_s:.0f} s left", flush=True)
            total = 0.0
    return average.module


def parse_arguments(description, weights, parts, steps, batch, rate):
    """What both programs take; `weights` says what is done to the C++ file, of `parts` the first is
    what is trained unless told otherwise."""
    parser = argparse.ArgumentParser(description=description.split("\n")[0])
    parser.add_argument("samples", help="the folder that make_samples filled")
    parser.add_argument("weights", help=f"the C++ file to {weights}")
    parser.add_argument("--start", metavar="FILE", help="a C++ file to go on from")
    if parts:
        parser.add_argument("--part", choices=parts, default=parts[0], help="what to train")
    parser.add_argument("--steps", type=int, default=steps)
    parser.add_argument("--batch", type=int, default=batch)
    parser.add_argument("--rate", type=float, default=rate)
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def check_enough(folder, known, judged_by):
    if len(known) == 0 or len(judged_by) == 0:
        raise SystemExit(f"{folder}: too few scenes, wanted 10 in a row or more")


def prepare(seed):
    """Makes a training repeatable; the random numbers to draw batches with."""
    torch.set_num_threads(1)  # more would also sum in another order
    torch.manual_seed(seed)
    return np.random.default_rng(seed)
