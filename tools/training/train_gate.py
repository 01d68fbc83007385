#!/usr/bin/env python3
"""Trains by what esi_net tells bright scenes in quick motion, its second set of edges' weights.

    python3 train_gate.py DIR BRIGHT_DIR esi/esi_net_weights.cc

DIR is what make_samples has filled, BRIGHT_DIR the same with `bright`, or with links to such scenes
of DIR. Reads the weights from the file and writes it anew with another gate: logistic regression on
the means of the features, the greater weights dearer.
Needs Debian's python3-torch and python3-numpy. A minute.
"""

import argparse

import torch
from torch.nn import functional as F

import samples
import weights_file
from network import Edges, Shading, means_of
from training import prepare

PENALTY = 1e-3  # of a weight's square


def means_in(folder):
    """Means by scene, each the patches' (n, FEATURES)."""
    return {seed: means_of(torch.from_numpy(features[:].copy()))
            for seed, features, _ in samples.scenes(folder)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("samples", help="the folder that make_samples filled")
    parser.add_argument("bright", help="one with bright scenes in quick motion")
    parser.add_argument("weights", help="the C++ file to read and to write")
    arguments = parser.parse_args()
    prepare(seed=1)
    bright = means_in(arguments.bright)
    other = {seed: means for seed, means in means_in(arguments.samples).items()
             if seed not in bright}
    edges, shading = Edges(), Shading()
    weights_file.read(edges, shading, arguments.weights)
    sides = [torch.cat(list(of_scenes.values())) for of_scenes in (other, bright)]
    means = torch.cat(sides)
    wanted = torch.cat([torch.zeros(len(sides[0])), torch.ones(len(sides[1]))])
    optimiser = torch.optim.LBFGS(edges.gate.parameters(), max_iter=500,
                                  line_search_fn="strong_wolfe")

    def loss():
        optimiser.zero_grad()
        value = F.binary_cross_entropy_with_logits(edges.gate(means)[:, 0], wanted)
        value = value + PENALTY * edges.gate.weight.square().sum()
        value.backward()
        return value

    optimiser.step(loss)
    with torch.no_grad():
        shares = [edges.second_share(side).mean().item() for side in sides]
    print(f"share of the second set: bright scenes {shares[1]:.2f}, others {shares[0]:.2f}")
    weights_file.write(edges, shading, arguments.weights)


if __name__ == "__main__":
    main()
