"""Image → what a network sees, as src/detect/learned/input.rs does it."""
import functools
import math

import numpy as np
from scipy import ndimage

SPACING = 8              # px between cones in what the network sees
DRIFT, CONTRAST = 8, 12  # Gaussians of the normalisation, px there


def mirror(index, n):
    index = np.mod(index, 2 * n)
    return np.where(index < n, index, 2 * n - 1 - index)


LARGE = 400  # px: above, bands are narrow enough in their matrices that filters are faster


def gaussian(plane, sigma):
    """Cut at ⌈4σ⌉, reflected at the border."""
    if max(plane.shape) > LARGE:
        return ndimage.gaussian_filter(plane, sigma, mode='reflect', radius=math.ceil(4 * sigma))
    return gaussian_matrix(plane.shape[0], sigma) @ plane @ gaussian_matrix(plane.shape[1], sigma).T


@functools.lru_cache(2048)
def gaussian_matrix(n, sigma):
    radius = math.ceil(4 * sigma)
    k = np.arange(-radius, radius + 1)
    weights = np.exp(-0.5 * (k / sigma) ** 2)
    matrix = np.zeros((n, n))
    for weight, offset in zip(weights / weights.sum(), k):
        np.add.at(matrix, (np.arange(n), mirror(np.arange(n) + offset, n)), weight)
    return matrix.astype(np.float32)


@functools.lru_cache(2048)
def resampling_matrix(n, step):
    """Every `step` px by cubics (Catmull and Rom), after a Gaussian that takes off what the wider grid cannot hold."""
    count = max(1, math.floor(n / step + 0.5))
    place = (np.arange(count) + 0.5) * step - 0.5
    first = np.floor(place).astype(int)
    t = place - first
    weights = (0.5 * t * (-1 + t * (2 - t)), 1 + 0.5 * t * t * (-5 + 3 * t),
               0.5 * t * (1 + t * (4 - 3 * t)), 0.5 * t * t * (t - 1))
    matrix = np.zeros((count, n))
    for k, weight in enumerate(weights):
        np.add.at(matrix, (np.arange(count), mirror(first + k - 1, n)), weight)
    if step > 1:
        matrix = matrix @ gaussian_matrix(n, 0.5 * math.sqrt(step * step - 1))
    return matrix.astype(np.float32)


def resample(image, step, step_x=None):
    return resampling_matrix(image.shape[0], step) @ image @ resampling_matrix(image.shape[1], step_x or step).T


def normalise(plane):
    level = plane - gaussian(plane, DRIFT)
    deviation = np.sqrt(np.maximum(gaussian(level * level, CONTRAST), 0))
    return level / (deviation + 0.1 * deviation.mean() + 1e-12)


def framed(plane, unit):
    """Mirrored at right and bottom to whole multiples of `unit`."""
    rows, columns = (mirror(np.arange(-(-n // unit) * unit), n) for n in plane.shape)
    return plane[np.ix_(rows, columns)]


CLEAR = 6.2  # clarity from which on an image has no noise to speak of
PER_OCTAVE, BINS, LONGEST, SIDE = 24, 121, 64, 512  # log-frequency bins of the ring, px of the transform


@functools.lru_cache(4)
def _bins():
    f = np.hypot(np.fft.fftfreq(SIDE)[:, None], np.fft.fftfreq(SIDE))
    return np.rint(PER_OCTAVE * np.log2(np.maximum(LONGEST * f, 1e-9))).astype(int)


def clarity(image, spacing):
    """Logarithm of the spectrum's power around the ring over that of detail finer than any cone, as
    src/detect/spacing/ring.rs has it."""
    sigma = max(image.shape) / 8
    level = image - gaussian(image, sigma)
    level = (level / np.sqrt(np.maximum(gaussian(level * level, sigma), 1e-12)))[:SIDE, :SIDE]
    h, w = level.shape
    power = np.abs(np.fft.fft2(level * np.outer(np.hanning(h + 2)[1:-1], np.hanning(w + 2)[1:-1]), (SIDE, SIDE))) ** 2
    bins = _bins()
    inside = (bins >= 0) & (bins < BINS)
    sums, counts = (np.bincount(bins[inside], weights, BINS) for weights in (power[inside], None))
    profile = np.log(sums / np.maximum(counts, 1) + 1e-12)
    cycles = spacing * 2 ** (np.arange(BINS) / PER_OCTAVE) / LONGEST
    finest = min(2.6, 0.5 * spacing / 1.15)
    mean = lambda low, high: profile[(cycles >= low) & (cycles <= high)].mean()
    return mean(0.8, 1.4) - mean(finest / 1.15, finest * 1.15)
