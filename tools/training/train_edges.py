#!/usr/bin/env python3
r"""Trains esi_net's edges on the samples of make_samples and writes esi/esi_net_weights.cc.

    make_samples 1 450 DIR                             # some 30 minutes on one core
    make_samples 1001 3000 BRIGHT_DIR bright           # some 20 minutes
    python3 train_edges.py DIR first.cc                # some 45 minutes
    python3 train_edges.py BRIGHT_DIR esi/esi_net_weights.cc --part second --start first.cc \
        --steps 17000                                  # some 20 minutes

There are two sets of weights: the first for any scene, the second, which begins as the first, for
bright scenes in quick motion. train_gate.py comes next, then train_shading.py: until then what
mixes the two is of chance or the start's, and there is no shade. Needs Debian's python3-torch and
python3-numpy. The same samples, seed and build of torch give the same weights.
"""

import numpy as np
import torch
from torch import nn
from torch.nn import functional as F

import samples
import weights_file
from network import Edges, Shading, means_of
from training import check_enough, parse_arguments, prepare, shown, train

CROP = 96  # of a patch: light and shade further off are the shading's
WINDOW = torch.tensor(np.exp(-((np.arange(11) - 5) ** 2) / (2 * 1.5**2)), dtype=torch.float32)
WINDOW /= WINDOW.sum()
# What contrast weighs beside flat places: a tag is a small part of a picture, and with its white
# cells only half as far from black as they are, which costs the mean hardly anything, is not read.
CONTRAST = 24


def blur(x):
    return F.conv2d(F.conv2d(x, WINDOW.view(1, 1, 1, -1)), WINDOW.view(1, 1, -1, 1))


def slopes(x):
    return x[:, :, :, 1:] - x[:, :, :, :-1], x[:, :, 1:] - x[:, :, :-1]


def loss(picture, truth):
    """1 - SSIM, plus how far grey and its slopes are off. Each place weighs by the truth's contrast
    in SSIM's window around it."""
    x = (picture - picture.mean((2, 3), keepdim=True)) / 4
    y = shown(truth) / 4
    mx, my = blur(x), blur(y)
    xx, yy, xy = blur(x * x) - mx * mx, blur(y * y) - my * my, blur(x * y) - mx * my
    c1, c2 = 1e-4, 9e-4
    ssim = (2 * mx * my + c1) * (2 * xy + c2) / ((mx * mx + my * my + c1) * (xx + yy + c2))
    weight = (1 + CONTRAST * yy.clamp(min=0).sqrt()) / (1 + CONTRAST / 10)  # 0.6 on the average
    everywhere = F.pad(weight, 4 * (len(WINDOW) // 2,), mode="replicate")
    edges = sum(((a - b).abs() * everywhere[..., :a.shape[2], :a.shape[3]]).mean()
                for a, b in zip(slopes(x), slopes(y)))
    # The mean over a patch is free, but not to wander off the middle grey.
    anchor = 0.1 * picture.mean((1, 2, 3)).square().mean()
    return (((1 - ssim) * weight).mean() + 4 * ((x - y).abs() * everywhere).mean() + 8 * edges +
            anchor)


def cut(features, truth, left, top):
    """CROP pixels each way, from a block's corner on, and the means of all of the features."""
    blocks = features[top:top + CROP // 2, left:left + CROP // 2]
    return (torch.from_numpy(blocks.astype(np.float32)),
            means_of(torch.from_numpy(np.array(features[None])))[0],
            torch.from_numpy(truth[:, 2 * top:2 * top + CROP, 2 * left:2 * left + CROP].copy()))


def draw_batch(patches, count, random):
    chosen = [patches[i] for i in random.integers(0, len(patches), count)]
    cuts = [cut(features[i], truth[i], *random.integers(0, (samples.PATCH - CROP) // 2 + 1, 2))
            for features, truth, i in chosen]
    x, means, y = map(torch.stack, zip(*cuts))
    x, y = samples.turned_any_way(x, y, random)
    return x, means, y


def main():
    arguments = parse_arguments(__doc__, "write", parts=["first", "second"], steps=40000,
                                batch=8, rate=2e-3)
    random = prepare(arguments.seed)
    known, judged_by = [], []
    for seed, features, truth in samples.scenes(arguments.samples):
        to = judged_by if samples.kept_back(seed) else known
        to += [(features, truth, i) for i in range(len(truth))]
    check_enough(arguments.samples, known, judged_by)
    edges, shading = Edges(), Shading()
    if arguments.start:
        weights_file.read(edges, shading, arguments.start)
    for parameter in shading.shade.parameters():
        nn.init.zeros_(parameter)
    edges.only = ["first", "second"].index(arguments.part)
    edges.requires_grad_(False)
    edges.sets[edges.only].requires_grad_(True)
    judged = [draw_batch(judged_by, arguments.batch, random) for _ in range(60)]

    def judge(network):
        with torch.no_grad():
            return np.mean([loss(network(x, means)[2], y).item() for x, means, y in judged])

    def draw_loss():
        x, means, y = draw_batch(known, arguments.batch, random)
        return loss(edges(x, means)[2], y)

    trained = train(edges, draw_loss, judge, arguments)
    if arguments.part == "first":
        trained.sets[1].load_state_dict(trained.sets[0].state_dict())
    weights_file.write(trained, shading, arguments.weights)


if __name__ == "__main__":
    main()
