"""esi/esi_net_weights.cc: whole numbers in the order esi/small_convolution.h wants them."""

import pathlib
import re

import numpy as np
import torch

from network import HIDDEN, MOST_VALUE, ONE

WEIGHT_BITS = 12  # kEsiNetWeightBits
UNIT = 2**WEIGHT_BITS


def read_edges(edges, path):
    """Takes over what write() has written."""
    text = pathlib.Path(path).read_text()
    found = {name: np.array(values.replace(",", " ").split(), np.float32)
             for name, values in re.findall(r"(k\w+)\[\] = \{(.*?)\};", text, re.S)}

    def take(parameter, values):
        parameter.data.copy_(torch.from_numpy(values.reshape(parameter.shape)))

    for i, layer in enumerate(edges.layers):
        w = found[f"kWeights{i}"].reshape(3, 3, -1, HIDDEN, 2).transpose(3, 2, 4, 0, 1)
        take(layer.weight, w.reshape(HIDDEN, -1, 3, 3) / UNIT)
        take(layer.bias, found[f"kBias{i}"] / (UNIT * ONE))
    take(edges.output.weight, found["kOutput"] / UNIT)
    take(edges.output.bias, found["kOutputBias"] / (UNIT * ONE))


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


def numbers(parameter, unit):
    return parameter.detach().numpy().astype(np.float64) * unit


def bits_below(layer, most_in):
    """Of a weight's 1: as many as keep every sum within 32 bits, WEIGHT_BITS at most."""
    most = (np.abs(numbers(layer.weight, 1)).sum((1, 2, 3)) * most_in +
            np.abs(numbers(layer.bias, ONE))).max()
    return min(WEIGHT_BITS, int(np.floor(np.log2(0.99 * 2**31 / max(most, 1)))))


def convolution(i, layer, bits):
    """Its two arrays; outputs that it lacks are nothing."""
    w = whole(numbers(layer.weight, 2**bits), 32767)
    b = whole(numbers(layer.bias, 2**bits * ONE), 2**31 - 1)
    w = np.pad(w, ((0, HIDDEN - len(w)), (0, 0), (0, 0), (0, 0)))
    pairs = w.transpose(2, 3, 1, 0).reshape(3, 3, -1, 2, HIDDEN).transpose(0, 1, 2, 4, 3)
    return (listed(f"kWeights{i}", "int16_t", pairs) +
            listed(f"kBias{i}", "int32_t", np.pad(b, (0, HIDDEN - len(b)))))


def write(edges, shading, path):
    signed = [*shading.up, shading.shade]
    layers = [*edges.layers, *shading.down, *signed]
    arrays, entries = "", []
    for i, layer in enumerate(layers):
        # Features are 2 at most; what goes up has been added to what went down.
        most_in = 2 * ONE if i == 0 else 2 * MOST_VALUE if layer in signed else MOST_VALUE
        bits = bits_below(layer, most_in)
        arrays += convolution(i, layer, bits)
        least = ", -kMostValue" if layer in signed else ""
        entries.append(f"      {{{layer.in_channels}, kWeights{i}, kBias{i}, {bits}{least}}},\n")
    arrays += listed("kOutput", "int16_t", whole(numbers(edges.output.weight, UNIT), 32767))
    arrays += listed("kOutputBias", "int32_t",
                     whole(numbers(edges.output.bias, UNIT * ONE), 2**31 - 1))
    count = len(edges.layers)
    pathlib.Path(path).write_text(f"""// Written by tools/training; do not edit.
#include "esi/esi_net_weights.h"

namespace nightjar::esi {{
namespace {{

// clang-format off
{arrays}// clang-format on

}}  // namespace

std::span<const Convolution> esi_net_layers() {{
  static const Convolution layers[] = {{
{"".join(entries[:count])}  }};
  return layers;
}}

std::span<const Convolution> esi_net_shading() {{
  static const Convolution layers[] = {{
{"".join(entries[count:])}  }};
  return layers;
}}

std::span<const std::int16_t, 4 * kEsiNetOutputIn> esi_net_output() {{ return kOutput; }}

std::span<const std::int32_t, 4> esi_net_output_bias() {{ return kOutputBias; }}

}}  // namespace nightjar::esi
""")
