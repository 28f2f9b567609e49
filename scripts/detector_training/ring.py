"""The spectrum in which Yellott's ring is looked for, as in src/detect/spacing/ring.rs.
"""
import functools

import numpy as np
from scipy import ndimage

# bins of log-frequency, from a period of 64 px on; px of the Fourier transform
PER_OCTAVE, BINS, SIZE = 24, 121, 512
CLEAR = 6.2  # clarity above which an image has hardly any noise


def gaussian(plane, sigma):
    """Returns the plane blurred by a Gaussian, reflected at the border."""
    return ndimage.gaussian_filter(plane, sigma, mode='reflect', truncate=4.0)


def flatten(image):
    """Returns the image less its slow drift, divided by its local contrast."""
    sigma = max(image.shape) / 8
    centred = image - gaussian(image, sigma)
    deviation = np.sqrt(gaussian(centred ** 2, sigma))
    return centred / np.maximum(deviation, 1e-3 * deviation.max())


@functools.cache
def terms():
    """Returns which terms of the transform count, and how they are shared among bins.

    For each of three weightings by direction (all, fx²/f², 1 − fx²/f²), each term is shared by two
    bins. Returned are the terms, the bins, the weights, and the sum of the weights in each bin.
    """
    fy, fx = np.fft.fftfreq(SIZE)[:, None], np.fft.rfftfreq(SIZE)[None]
    f = np.hypot(fx, fy)
    inside = (f > 1 / 64 / 1.05) & (f < 0.5 * 1.03)
    along_x = (fx ** 2 / np.maximum(f, 1e-9) ** 2)[inside]
    twice = (np.where((fx > 0) & (fx < 0.5), 2.0, 1.0) * np.ones_like(f))[inside]
    place = PER_OCTAVE * np.log2(64 * f[inside])
    low = np.floor(place).astype(int)
    part = place - low
    bins = [np.clip(low + k, 0, BINS + 2) for k in (1, 2)]
    weights = [[share * direction * twice for share in (1 - part, part)]
               for direction in (np.ones_like(along_x), along_x, 1 - along_x)]
    sums = [binned(bins, shares, 1) for shares in weights]
    return inside, bins, weights, sums


def binned(bins, shares, power):
    """Returns the sum of the weighted power in each bin."""
    return sum(np.bincount(bin, share * power, BINS + 3) for bin, share in zip(bins, shares))


def profiles(image):
    """Returns three profiles of log power over log-frequency.

    They are of all directions, weighted by fx²/f², and weighted by 1 − fx²/f². Of a large image,
    only the upper left part counts.
    """
    image = image[:SIZE, :SIZE]
    h, w = image.shape
    tapered = flatten(image) * np.outer(np.hanning(h + 2)[1:-1], np.hanning(w + 2)[1:-1])
    inside, bins, weights, sums = terms()
    power = (np.abs(np.fft.rfft2(tapered, (SIZE, SIZE))) ** 2)[inside]
    return np.array([np.log((binned(bins, shares, power) / np.maximum(total, 1e-12))[1:BINS + 1] + 1e-12)
                     for shares, total in zip(weights, sums)])


def clarity(profile, spacing):
    """Returns the log power around the ring of a spacing in px over that of finer detail."""
    cycles = spacing * 2 ** (np.arange(BINS) / PER_OCTAVE) / 64
    finest = min(2.6, 0.5 * spacing / 1.15)
    mean = lambda low, high: profile[(cycles >= low) & (cycles <= high)].mean()
    return mean(0.8, 1.4) - mean(finest / 1.15, finest * 1.15)
