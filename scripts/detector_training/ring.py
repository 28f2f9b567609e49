"""The spectrum in which Yellott's ring is looked for, as src/detect/spacing/ring.rs has it."""
import functools

import numpy as np
from scipy import ndimage

PER_OCTAVE, BINS, SIZE = 24, 121, 512  # log-frequency bins from a period of 64 px on; px of the transform
CLEAR = 6.2                            # clarity from which on an image has no noise to speak of


def gaussian(plane, sigma):
    return ndimage.gaussian_filter(plane, sigma, mode='reflect', truncate=4.0)


def flatten(image):
    sigma = max(image.shape) / 8
    centred = image - gaussian(image, sigma)
    deviation = np.sqrt(gaussian(centred ** 2, sigma))
    return centred / np.maximum(deviation, 1e-3 * deviation.max())


@functools.cache
def terms():
    """Of the transform: which terms count, and for each of three directions (all, fx²/f², 1 − fx²/f²) the bins that share a
    term, with what weight, and the sum of the weights in a bin."""
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
    return sum(np.bincount(bin, share * power, BINS + 3) for bin, share in zip(bins, shares))


def profiles(image):
    """Log power over log-frequency: all, weighted by fx²/f², weighted by 1 − fx²/f². Of a large image, of its upper left."""
    image = image[:SIZE, :SIZE]
    h, w = image.shape
    tapered = flatten(image) * np.outer(np.hanning(h + 2)[1:-1], np.hanning(w + 2)[1:-1])
    inside, bins, weights, sums = terms()
    power = (np.abs(np.fft.rfft2(tapered, (SIZE, SIZE))) ** 2)[inside]
    return np.array([np.log((binned(bins, shares, power) / np.maximum(total, 1e-12))[1:BINS + 1] + 1e-12)
                     for shares, total in zip(weights, sums)])


def clarity(profile, spacing):
    """Log power around the ring of that spacing, px, above that of detail finer than any cone."""
    cycles = spacing * 2 ** (np.arange(BINS) / PER_OCTAVE) / 64
    finest = min(2.6, 0.5 * spacing / 1.15)
    mean = lambda low, high: profile[(cycles >= low) & (cycles <= high)].mean()
    return mean(0.8, 1.4) - mean(finest / 1.15, finest * 1.15)
