"""esi/esi_net_weights.cc: whole numbers in the order esi/small_convolution.h wants them."""

import pathlib
import re

import numpy as np
import torch

from network import HIDDEN, MOST_VALUE, ONE

WEIGHT_BITS = 12  # kEsiNetWeightBits
UNIT = 2**WEIGHT_BITS


def read(edges, shading, path):
    """Takes over what write() has written."""
    text = pathlib.Path(path).read_text()
    found = {name: np.array(values.replace(",", " ").split(), np.float32)
             for name, values in re.findall(r"(k\w+)\[\] = \{(.*?)\};", text, re.S)}
    units = [2**int(bits) for bits in re.findall(r"kBias\d+, (\d+)", text)]

    def take(parameter, values):
        parameter.data.copy_(torch.from_numpy(values.reshape(parameter.shape)))

    layers = in_order(edges, shading)
    for i, (layer, unit) in enumerate(zip(layers, units, strict=True)):
        w = found[f"kWeights{i}"].reshape(3, 3, -1, HIDDEN, 2).transpose(3, 2, 4, 0, 1)
        take(layer.weight, w.reshape(HIDDEN, -1, 3, 3)[:layer.out_channels] / unit)
        take(layer.bias, found[f"kBias{i}"][:layer.out_channels] / (unit * ONE))
    for i, weights in enumerate(edges.sets):
        take(weights.output.weight, found[f"kOutput{i}"] / UNIT)
        take(weights.output.bias, found[f"kOutputBias{i}"] / (UNIT * ONE))
    take(edges.gate.weight, found["kGate"][:-1] / UNIT)
    take(edges.gate.bias, found["kGate"][-1:] / UNIT)


def in_order(edges, shading):
    return [*edges.sets[0].layers, *edges.sets[1].layers,
            *shading.down, *shading.up, shading.shade]


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
    layers = in_order(edges, shading)
    count = len(edges.sets[0].layers)
    signed = [*shading.up, shading.shade]
    # Features are 2 at most; what goes up has been added to what went down.
    firsts = [weights.layers[0] for weights in edges.sets]
    bits = [bits_below(layer, 2 * ONE if layer in firsts else
                       2 * MOST_VALUE if layer in signed else MOST_VALUE) for layer in layers]
    for i in range(count):  # what is mixed has the same
        bits[i] = bits[count + i] = min(bits[i], bits[count + i])
    arrays, entries = "", []
    for i, layer in enumerate(layers):
        arrays += convolution(i, layer, bits[i])
        least = ", -kMostValue" if layer in signed else ""
        entries.append(f"{{{layer.in_channels}, kWeights{i}, kBias{i}, {bits[i]}{least}}},\n")
    for i, weights in enumerate(edges.sets):
        arrays += listed(f"kOutput{i}", "int16_t",
                         whole(numbers(weights.output.weight, UNIT), 32767))
        arrays += listed(f"kOutputBias{i}", "int32_t",
                         whole(numbers(weights.output.bias, UNIT * ONE), 2**31 - 1))
    gate = torch.cat([edges.gate.weight.flatten(), edges.gate.bias])
    arrays += listed("kGate", "int32_t", whole(numbers(gate, UNIT), 2**31 - 1))
    pathlib.Path(path).write_text(f"""// Written by tools/training; do not edit.
#include "esi/esi_net_weights.h"

namespace nightjar::esi {{
namespace {{

// clang-format off
{arrays}// clang-format on

}}  // namespace

const std::array<EdgeWeights, 2>& esi_net_edges() {{
  static const std::array<EdgeWeights, 2> sets = {{
      EdgeWeights{{{{{{{indented(entries[:count])}                  }}}},
                  kOutput0,
                  kOutputBias0}},
      EdgeWeights{{{{{{{indented(entries[count:2 * count])}                  }}}},
                  kOutput1,
                  kOutputBias1}}}};
  return sets;
}}

std::span<const std::int32_t, kPixelFeatures + 1> esi_net_gate() {{ return kGate; }}

std::span<const Convolution> esi_net_shading() {{
  static const Convolution layers[] = {{
{"".join("      " + entry for entry in entries[2 * count:])}  }};
  return layers;
}}

}}  // namespace nightjar::esi
""")


def indented(entries):
    return "\n" + "".join("                      " + entry for entry in entries)
