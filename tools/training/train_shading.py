#!/usr/bin/env python3
"""Trains esi_net's shading on the samples of make_samples, its edges kept as they are.

    make_samples 1 450 DIR                              # some 30 minutes on one core
    python3 train_shading.py DIR esi/esi_net_weights.cc # some 20 minutes

Reads the edges from the file and writes it anew, with the mean of what the shading was in the
last half of the steps: on recordings that does better than any one of them. Needs Debian's
python3-torch and python3-numpy. The same samples, seed and build of torch give the same weights.
"""

import time

import numpy as np
import torch
from torch.nn import functional as F

import samples
import weights_file
from network import Edges, Shading, halved, means_of
from training import check_enough, parse_arguments, prepare, shown, train

VIEWS = 3  # of each patch, turned this way and that
# Of the shade that fits the samples best: most of what real frames gain by it, and hardly any of
# what fine texture loses (docs/decisions/0009).
SHARE = 0.6


def seen_of(edges, features, truth):
    """Of some patches: what the shading sees (n, 32, 48, 48), and by how much the edges' picture
    is too dark (n, 1, 48, 48), the mean being free."""
    second, third, picture = edges(features, means_of(features))
    lacks = shown(truth) - (picture - picture.mean((2, 3), keepdim=True))
    # What is finer than 4 px no shade can mend: left out, the loss is less by a constant.
    return halved(torch.cat([second, third], 1)), F.avg_pool2d(lacks, 4)


def see(edges, folder, random):
    """All patches, VIEWS times, as halves of a float; and the seeds that they are of."""
    seen, lacking, seeds, start, said_s = [], [], [], time.time(), 0.0
    scenes = list(samples.scenes(folder))
    for done, (seed, features, truth) in enumerate(scenes):
        for first in VIEWS * list(range(0, len(truth), 8)):
            batch = slice(first, first + 8)
            x, y = samples.turned_any_way(torch.from_numpy(features[batch].astype(np.float32)),
                                          torch.from_numpy(truth[batch].copy()), random)
            with torch.no_grad():
                hidden, lacks = seen_of(edges, x, y)
            seen.append(hidden.half())
            lacking.append(lacks.half())
            seeds += [seed] * len(lacks)
        passed_s = time.time() - start
        if passed_s - said_s > 10:
            said_s = passed_s
            left_s = passed_s / (done + 1) * (len(scenes) - done - 1)
            print(f"{done + 1} of {len(scenes)} scenes looked at, {left_s:.0f} s left", flush=True)
    return torch.cat(seen), torch.cat(lacking), np.array(seeds)


def loss(shade, lacks):
    """Mean square of what is still lacking; the mean over a patch is free, but not to wander."""
    mean = shade.mean((2, 3), keepdim=True)
    return (shade - mean - lacks).square().mean() + 0.001 * mean.square().mean()


def scale(layer, by):
    with torch.no_grad():
        for parameter in layer.parameters():
            parameter.mul_(by)


def main():
    arguments = parse_arguments(__doc__, "read the edges from, and to write", parts=[],
                                steps=16000, batch=24, rate=2e-3)
    random = prepare(arguments.seed)
    edges, shading = Edges(), Shading()
    if arguments.start:
        weights_file.read(Edges(), shading, arguments.start)
        scale(shading.shade, 1 / SHARE)
    weights_file.read(edges, Shading(), arguments.weights)
    seen, lacking, seeds = see(edges, arguments.samples, random)
    kept_back = samples.kept_back(seeds)
    known, judged_by = np.flatnonzero(~kept_back), np.flatnonzero(kept_back)
    check_enough(arguments.samples, known, judged_by)
    judged_by = random.choice(judged_by, min(600, len(judged_by)), replace=False)

    def loss_of(network, chosen):
        return loss(network(seen[chosen].float()), lacking[chosen].float())

    def judge(network):
        with torch.no_grad():
            return np.mean([loss_of(network, part).item()
                            for part in np.array_split(judged_by, 24)])

    print(f"{len(known)} views to learn from, {len(judged_by)} to judge by; "
          f"without a shade {lacking[judged_by].float().square().mean():.4f}", flush=True)
    trained = train(shading, lambda: loss_of(shading, random.choice(known, arguments.batch)), judge,
                    arguments)
    scale(trained.shade, SHARE)
    weights_file.write(edges, trained, arguments.weights)


if __name__ == "__main__":
    main()
