"""Marked images, and the random drawings of them that a network is trained on.

`Sample` reads an image and its marks. `draw` makes one drawing: the image altered at random and
resampled to about the network's spacing, with its target.
"""
import math
import os

import numpy as np
import torch
import torch.nn.functional as F
from PIL import Image

from .marks import density_spacing, read_marks, subject
from .plane import SPACING, gaussian, normalise, resample

KNOWN = 3    # margin around the marks, in px of the network, in which the target is known
GRID = 24    # steps per octave to which factors are rounded, so that few matrices are needed


class Sample:
    """A marked image, with its subject and its cone spacing in px."""

    def __init__(self, path, origin):
        """Reads the image `path` and its marks; `origin` is the coordinate of the first pixel."""
        self.name = os.path.basename(path)[:-4]
        self.subject = subject(path)
        self.image = np.asarray(Image.open(path).convert('L'), np.float32) / 255
        self.marks = read_marks(path, origin)
        self.true = density_spacing(self.marks, self.image.shape)
        self.start = self.true  # replaced by the spacing that the program finds
        self.classical = self.marks[:0]


def rounded(step):
    """Returns the factor `step` rounded to the nearest of `GRID` steps per octave."""
    return 2 ** (round(GRID * math.log2(step)) / GRID)


def disturbed(image, spacing, recipe, rng):
    """Returns the image as another camera might show it, and the factor by which it is smaller."""
    factor = 1.0
    if rng.random() < 0.7:
        image = np.clip(image, 0, 1) ** math.exp(rng.uniform(-0.9, 0.9))
    if rng.random() < recipe.soft:  # as by a camera with fewer pixels
        factor = rounded(max(1.0, spacing / rng.uniform(4.5, 8)))
        image = resample(image, factor)
    if rng.random() < 0.5:
        noise = rng.standard_normal(image.shape, np.float32)
        kind = rng.random()
        if kind < 0.2:
            noise = gaussian(noise, round(rng.uniform(0.4, 1), 1))
            noise /= noise.std()
        elif kind < 0.45:  # Poisson-like noise: counted photons
            noise *= np.sqrt(np.maximum(image, 0) / max(image.mean(), 1e-6))
        image = image + rng.uniform(0, recipe.noise) * image.std() * noise
    if rng.random() < 0.15:  # uneven illumination
        drift = enlarged(rng.standard_normal((4, 4)).astype(np.float32), image.shape, 'bicubic')
        image = image * np.exp(0.3 * drift)
    return np.ascontiguousarray(image, np.float32), factor


def resampled(image, marks, step, recipe, rng):
    """Returns the image sampled about every `step` px, its marks, and where the target is known.

    At random, the image is bent, or rotated and sheared, or only stretched a little.
    """
    stretch = math.exp(rng.uniform(-0.06, 0.06))
    if rng.random() < recipe.gradient:
        return bent(image, marks, step, rng)
    if rng.random() < 0.4:
        angle, shear = rng.uniform(-recipe.angle, recipe.angle), rng.uniform(-0.06, 0.06)
        turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
        to_image = turn @ np.array([[1, shear], [0, 1]]) @ np.diag([stretch * step, step / stretch])
        h, w = image.shape
        size = max(1, round(w / step)), max(1, round(h / step))
        origin = np.array([w - 1, h - 1]) / 2 - to_image @ (np.array(size) - 1) / 2
        places = np.stack(np.meshgrid(*map(np.arange, size)), -1) @ to_image.T + origin
        blurred = gaussian(image, 0.5 * math.sqrt(step * step - 1)) if step > 1 else image
        return cubic(blurred, places), np.linalg.solve(to_image, (marks - origin).T).T, inside(places, marks, KNOWN * step)
    step_x, step_y = rounded(step * stretch), rounded(step / stretch)
    plane = resample(image, step_y, step_x)
    marks = (marks + 0.5) / [step_x, step_y] - 0.5
    places = np.stack(np.meshgrid(np.arange(plane.shape[1]), np.arange(plane.shape[0])), -1)
    return plane, marks, inside(places, marks, KNOWN)


def bent(image, marks, step, rng):
    """Returns the same as `resampled`, with a spacing that grows from one side to the other.

    It changes by 5–40 % between the middle and either side. The map (exp(b·z) − 1)/b is conformal,
    so that the neighbourhood of a cone keeps its shape.
    """
    h, w = image.shape
    size = max(1, round(w / step)), max(1, round(h / step))
    middle, image_middle = (np.array(size) - 1) / 2, np.array([w - 1, h - 1]) / 2
    bend = rng.uniform(0.05, 0.4) / (max(size) / 2) * np.exp(2j * math.pi * rng.random())
    x, y = np.meshgrid(*(np.arange(n) - m for n, m in zip(size, middle)))
    places = (np.exp(bend * (x + 1j * y)) - 1) / bend * step
    places = np.stack([places.real, places.imag], -1) + image_middle
    marks_known = inside(places, marks, KNOWN * step)
    marks_known *= ((places > -0.5) & (places < [w - 0.5, h - 0.5])).all(-1)
    marks = np.log(1 + bend * ((marks - image_middle) @ [1, 1j]) / step) / bend
    blurred = gaussian(image, 0.5 * math.sqrt(step * step - 1)) if step > 1 else image
    return cubic(blurred, places), np.stack([marks.real, marks.imag], 1) + middle, marks_known


def inside(places, marks, around):
    """Returns 1 at places in the rectangle of the marks, widened by `around`, and 0 elsewhere."""
    return ((places >= marks.min(0) - around) & (places <= marks.max(0) + around)).all(-1).astype(np.float32)


def cubic(image, places):
    """Returns the image at places x, y by cubic interpolation, reflected at the border."""
    h, w = image.shape
    grid = torch.from_numpy(((places + 0.5) * (2 / w, 2 / h) - 1).astype(np.float32))
    return F.grid_sample(torch.from_numpy(image)[None, None], grid[None], 'bicubic', 'reflection', False)[0, 0].numpy()


def enlarged(image, shape, how):
    """Returns the image in another shape; the outer edges of the image stay in place."""
    return F.interpolate(torch.from_numpy(image)[None, None], shape, mode=how)[0, 0].numpy()


def bumps(marks, shape):
    """Returns the target: at each pixel the highest of the Gaussians (1 px wide) at the marks."""
    h, w = shape
    target = np.zeros((h + 16, w + 16), np.float32)
    near = marks[((marks > -5) & (marks < [w + 5, h + 5])).all(1)]
    offsets = np.arange(-5, 6)
    middle = np.rint(near).astype(int)
    ys, xs = middle[:, 1, None, None] + offsets[:, None], middle[:, 0, None, None] + offsets
    height = np.exp(-0.5 * ((ys - near[:, 1, None, None]) ** 2 + (xs - near[:, 0, None, None]) ** 2))
    np.maximum.at(target, (np.clip(ys, -8, h + 7) + 8, np.clip(xs, -8, w + 7) + 8), height.astype(np.float32))
    return target[8:-8, 8:-8]


def draw(sample, recipe, rng):
    """Returns one drawing as four planes: input, target, where it is known, where the image is.

    The image lies anywhere on the canvas. Its borders are visible, as they are in use.
    """
    image, factor = disturbed(sample.image, sample.true, recipe, rng)
    step = sample.true / factor * math.exp(rng.uniform(-0.15, 0.15)) / SPACING
    plane, marks, known = resampled(image, (sample.marks + 0.5) / factor - 0.5, step, recipe, rng)
    if rng.random() < 0.3:
        plane = gaussian(plane, round(rng.uniform(0.3, 1), 1))
    planes = normalise(plane), bumps(marks, plane.shape), known, np.ones_like(known)
    side = recipe.side
    out = np.zeros((len(planes), side, side), np.float32)
    source, target = [], []
    for n in plane.shape:
        first = int(rng.integers(0, side - n + 1)) if n <= side else 0
        cut = int(np.clip(rng.integers(-8, n - side + 9), 0, n - side)) if n > side else 0
        source.append(slice(cut, cut + side))
        target.append(slice(first, first + n))
    for canvas, values in zip(out, planes):
        canvas[tuple(target)] = values[tuple(source)]
    if rng.random() < 0.5:
        out = out[:, :, ::-1].copy()
        if recipe.modality == 'split':  # a mirrored split detector has the other polarity
            out[0] *= -1
    if rng.random() < 0.5:
        out = out[:, ::-1]
    if recipe.modality != 'split' and rng.random() < 0.5:
        out = out.transpose(0, 2, 1)
    # stains make cells darker or brighter than the background
    if recipe.modality == 'histology' and rng.random() < 0.5:
        out[0] *= -1
    return np.ascontiguousarray(out)
