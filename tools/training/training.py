"""What both trainings do alike."""

import argparse
import time

import numpy as np
import torch
from torch import nn


def warmed_up(rate, step):
    return rate * min(1, step / 200)


def train(network, draw_loss, steps, rate_at, report, after_step=lambda step: None):
    """Adam. `draw_loss()` gives a batch's loss, `rate_at(step)` the rate, and `report()` what to
    say of the network every 500 steps."""
    optimiser = torch.optim.Adam(network.parameters())
    start, total = time.time(), 0.0
    for step in range(1, steps + 1):
        for group in optimiser.param_groups:
            group["lr"] = rate_at(step)
        value = draw_loss()
        optimiser.zero_grad()
        value.backward()
        nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        optimiser.step()
        after_step(step)
        total += value.item()
        if step % 500 == 0:
            left_s = (time.time() - start) / step * (steps - step)
            print(f"step {step} of {steps}: loss {total / 500:.4f}, {report()}, {left_s:.0f} s left",
                  flush=True)
            total = 0.0


def parse_arguments(description, weights, steps, batch, rate):
    """What both programs take; `weights` says what is done to the C++ file."""
    parser = argparse.ArgumentParser(description=description.split("\n")[0])
    parser.add_argument("samples", help="the folder that make_samples filled")
    parser.add_argument("weights", help=f"the C++ file to {weights}")
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
