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


class Edges(nn.Module):
    """Three 3x3 layers, joined with the features themselves, which are sharper."""

    def __init__(self):
        super().__init__()
        self.layers = nn.ModuleList([convolution(4 * FEATURES), convolution(), convolution()])
        self.output = nn.Conv2d(HIDDEN + 4 * FEATURES, 4, 1)

    def forward(self, stored):
        """Features as they are stored (n, h, w, 32) -> what the second and the third layer see
        (n, 16, h, w), and the picture (n, 1, 2 h, 2 w) in deviations."""
        features = stored.permute(0, 3, 1, 2) / ONE
        second = bounded(self.layers[1](bounded(self.layers[0](features))))
        third = bounded(self.layers[2](second))
        return second, third, F.pixel_shuffle(self.output(torch.cat([third, features], 1)), 2)


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
