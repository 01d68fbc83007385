"""esi_net's two parts as torch sees them: edges, and the shading added to them."""

import torch
from torch import nn
from torch.nn import functional as F

FEATURES = 8  # kPixelFeatures
HIDDEN = 16  # kConvolutionOut
ONE = 512  # kFeatureOne
MOST_VALUE = 8191  # kMostValue
SHADING_LEVELS = 4  # kShadingLevels
SHADE_LEVEL = 1  # kShadeLevel


def convolution(channels=HIDDEN, out=HIDDEN):
    return nn.Conv2d(channels, out, 3, padding=1)


def bounded(x):
    """What the program does to a layer's values."""
    return F.relu(x).clamp(max=MOST_VALUE / ONE)


class EdgeWeights(nn.Module):
    """Three 3x3 layers, joined with the features themselves, which are sharper."""

    def __init__(self):
        super().__init__()
        self.layers = nn.ModuleList([convolution(4 * FEATURES), convolution(), convolution()])
        self.output = nn.Conv2d(HIDDEN + 4 * FEATURES, 4, 1)


class Edges(nn.Module):
    """Two sets of weights, mixed for each picture by a share that its features' means give."""

    def __init__(self):
        super().__init__()
        self.sets = nn.ModuleList([EdgeWeights(), EdgeWeights()])
        self.gate = nn.Linear(FEATURES, 1)
        self.only = None  # 0 or 1: as if there were that set alone

    def second_share(self, means):
        """Of the second set, 0 to 1, from what means_of() says (n, FEATURES)."""
        if self.only is not None:
            return torch.full((len(means), 1), float(self.only))
        return (0.5 + self.gate(means)).clamp(0, 1)  # of odds: none below 0.6, all above 1.6

    def forward(self, stored, means):
        """Features as they are stored (n, h, w, 32), and those of the whole picture in the mean ->
        what the second and the third layer see (n, 16, h, w), and the picture (n, 1, 2 h, 2 w) in
        deviations."""
        share = self.second_share(means).view(-1, 1, 1, 1)

        def mixed(one, other, x):
            return one(x) + share * (other(x) - one(x))

        features = stored.permute(0, 3, 1, 2) / ONE
        seen = [features]
        for one, other in zip(self.sets[0].layers, self.sets[1].layers):
            seen.append(bounded(mixed(one, other, seen[-1])))
        _, _, second, third = seen
        joined = torch.cat([third, features], 1)
        return second, third, F.pixel_shuffle(
            mixed(self.sets[0].output, self.sets[1].output, joined), 2)


def means_of(stored):
    """Of whole pictures (n, h, w, 32), each fourth row of blocks -> (n, FEATURES)."""
    return stored[:, ::4].float().mean((1, 2)).view(-1, 4, FEATURES).mean(1) / ONE


class Shading(nn.Module):
    """A pyramid, down and up again as far as SHADE_LEVEL: one value for 8x8 pixels."""

    def __init__(self):
        super().__init__()
        self.down = nn.ModuleList([convolution(2 * HIDDEN),
                                   *(convolution() for _ in range(SHADING_LEVELS - 1))])
        self.up = nn.ModuleList(convolution() for _ in range(SHADING_LEVELS - 1 - SHADE_LEVEL))
        self.shade = convolution(out=1)
        with torch.no_grad():  # little at first
            self.shade.weight.mul_(0.1)
            self.shade.bias.zero_()

    def forward(self, hidden):
        """Both layers' values, halved (n, 32, h, w) -> the shade (n, 1, h, w) in deviations."""
        passed = []
        for i, layer in enumerate(self.down):
            hidden = F.relu(layer(halved(hidden) if i > 0 else hidden))
            passed.append(hidden)
        hidden = passed.pop()
        for layer in self.up:
            finer = passed.pop()
            doubled = layer(hidden).repeat_interleave(2, 2).repeat_interleave(2, 3)
            hidden = finer + doubled[:, :, :finer.shape[2], :finer.shape[3]]
        shade = self.shade(hidden)
        for _ in range(SHADE_LEVEL):
            shade = F.interpolate(shade, scale_factor=2, mode="bilinear", align_corners=False)
        return shade


def halved(x):
    return F.avg_pool2d(x, 2, ceil_mode=True, count_include_pad=False)
