"""The network, its training, and the file of weights that the program reads.
"""
import json
import math
import struct
from pathlib import Path

import numpy as np
import torch
import torch.nn.functional as F

from .draw import draw
from .plane import SPACING, framed, gaussian, normalise, resample

TAUGHT = 0.7  # weight of the teachers' probability in the target
UNIT = 4  # width and height of the network's input are multiples of this


class UNet(torch.nn.Module):
    """U-Net that halves the resolution twice."""

    def __init__(self, top, middle, bottom):
        """Makes the layers; the arguments are channels at full, half and quarter resolution."""
        super().__init__()
        layer = lambda inputs, outputs, side=3: torch.nn.Conv2d(inputs, outputs, side, padding=side // 2)
        self.first, self.top = layer(1, top, 5), layer(top, top)
        self.down, self.middle = layer(top, middle), layer(middle, middle)
        self.deep, self.bottom = layer(middle, bottom), layer(bottom, bottom)
        self.rise, self.join = layer(bottom, middle, 1), layer(middle, middle)
        self.lift, self.merge = layer(middle, top, 1), layer(top, top)
        self.last = layer(top, 1, 1)
        for part in self.children():
            torch.nn.init.normal_(part.weight, 0, math.sqrt(2 / part.weight[0].numel()))
            torch.nn.init.zeros_(part.bias)
        torch.nn.init.constant_(self.last.bias, -2)

    def forward(self, seen, mask):
        """Returns the logit of every pixel.

        `mask` is 0 outside the image; every layer's output is multiplied by it.
        """
        half, quarter = mask[:, :, ::2, ::2], mask[:, :, ::4, ::4]
        double = lambda maps: F.interpolate(maps, scale_factor=2, mode='nearest')
        halved = lambda maps: F.avg_pool2d(maps, 2)
        top = F.relu(self.top(F.relu(self.first(seen)) * mask)) * mask
        middle = F.relu(self.middle(F.relu(self.down(halved(top))) * half)) * half
        bottom = F.relu(self.bottom(F.relu(self.deep(halved(middle))) * quarter)) * quarter
        joined = F.relu(self.join((double(self.rise(bottom)) + middle) * half)) * half
        merged = F.relu(self.merge((double(self.lift(joined)) + top) * mask)) * mask
        return self.last(merged)[:, 0]


def train(samples, recipe, seed, epochs, teacher=None):
    """Returns a network trained on random drawings of the samples.

    AdamW with a one-cycle learning rate minimises the cross-entropy; the weights returned are an
    exponential moving average. Convolutions are in bf16. The probability by `teacher`, if given,
    makes up most of the target, and all of it where nobody marked.
    """
    rng = np.random.default_rng(seed)
    torch.manual_seed(seed)
    network, averaged = (UNet(*recipe.widths).to(memory_format=torch.channels_last) for _ in range(2))
    averaged.load_state_dict(network.state_dict())
    steps = max(20, epochs * len(samples) // recipe.batch)
    optimiser = torch.optim.AdamW(network.parameters(), lr=recipe.rate, weight_decay=0.01)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, recipe.rate, total_steps=steps, pct_start=0.2,
                                                   final_div_factor=1000)
    order = []
    for step in range(steps):
        while len(order) < recipe.batch:
            order.extend(rng.permutation(len(samples)))
        batch = torch.from_numpy(np.stack([draw(samples[order.pop()], recipe, rng) for _ in range(recipe.batch)]))
        seen, mask = (batch[:, k:k + 1].contiguous(memory_format=torch.channels_last) for k in (0, 3))
        target, known = batch[:, 1], batch[:, 2]
        with torch.autocast('cpu', torch.bfloat16):
            logits = network(seen, mask.bfloat16())
            if teacher:
                with torch.no_grad():
                    taught = torch.sigmoid(teacher(seen, mask.bfloat16()).float())
                target = torch.where(known > 0, TAUGHT * taught + (1 - TAUGHT) * target, taught)
                known = torch.where(known > 0, known, mask[:, 0])
        loss = F.binary_cross_entropy_with_logits(logits.float(), target, reduction='none')
        loss = (loss * known).sum() / known.sum()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
        keep = min(0.995, (1 + step) / (10 + step))
        with torch.no_grad():
            for mean, weight in zip(averaged.parameters(), network.parameters()):
                mean.lerp_(weight, 1 - keep)
    return averaged.eval()


def see(image, spacing, network, sign):
    """Returns the logits of an image whose cones are `spacing` px apart.

    Unless `sign` is None, they are means over the four mirrored views. The image mirrored along x
    is multiplied by `sign`.
    """
    seen = normalise(resample(image, spacing / SPACING))
    h, w = seen.shape
    seen = torch.from_numpy(np.ascontiguousarray(framed(seen, UNIT)))[None, None]
    mask = torch.ones_like(seen)
    with torch.no_grad():
        if sign is None:
            logits = network(seen, mask)[0]
        else:
            views = [(seen, ()), (seen, (2,)), (sign * seen, (3,)), (sign * seen, (2, 3))]
            back = lambda logits, axes: logits.flip([axis - 1 for axis in axes])[0]
            logits = sum(back(network(view.flip(axes), mask), axes) for view, axes in views) / len(views)
    return logits.numpy()[:h, :w]


class Mean(torch.nn.Module):
    """Mean logit of networks that differ in the seed of their training."""

    def __init__(self, members):
        """Takes the networks whose logits are averaged."""
        super().__init__()
        self.members = torch.nn.ModuleList(members)

    def forward(self, seen, mask):
        """Returns the mean logit of every pixel."""
        return sum(member(seen, mask) for member in self.members) / len(self.members)


def write(path, network, metadata, sign):
    """Writes the weights as a safetensors file, and an example for the program's tests.

    Weights are in the order out, in, height, width. The example, .example.safetensors beside them,
    holds a small image with 10 px between cones and its logits.
    """
    image = gaussian(np.random.default_rng(1).random((44, 40), np.float32), 1.5)
    safetensors(path, {name: value.numpy() for name, value in network.state_dict().items()}, metadata)
    safetensors(Path(path).with_suffix('.example.safetensors'), {'image': image, 'logits': see(image, 10.0, network, sign)}, {})


def safetensors(path, tensors, metadata):
    """Writes tensors and metadata as a safetensors file of 32-bit floats."""
    header, blob = {'__metadata__': {k: str(v) for k, v in metadata.items()}}, b''
    for name, value in tensors.items():
        value = np.ascontiguousarray(value, '<f4')
        header[name] = {'dtype': 'F32', 'shape': list(value.shape), 'data_offsets': [len(blob), len(blob) + value.nbytes]}
        blob += value.tobytes()
    text = json.dumps(header).encode()
    text += b' ' * (-len(text) % 8)
    Path(path).write_bytes(struct.pack('<Q', len(text)) + text + blob)
