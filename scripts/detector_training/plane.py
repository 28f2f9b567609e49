"""Preparation of an image for a network, as in src/detect/learned/input.rs.

The image is resampled to the network's spacing and normalised by its local mean and deviation.
"""
import functools
import math

import numpy as np
from scipy import ndimage

SPACING = 8              # px between cones in the network's input
DRIFT, CONTRAST = 8, 12  # widths of the Gaussians of the normalisation, in px of the input


def mirror(index, n):
    """Returns indices 0 to n − 1, those beyond the border reflected."""
    index = np.mod(index, 2 * n)
    return np.where(index < n, index, 2 * n - 1 - index)


LARGE = 400  # px; in larger images filters are faster than products with banded matrices


def gaussian(plane, sigma):
    """Returns the plane blurred by a Gaussian that is cut at ⌈4σ⌉, reflected at the border."""
    if max(plane.shape) > LARGE:
        return ndimage.gaussian_filter(plane, sigma, mode='reflect', radius=math.ceil(4 * sigma))
    return gaussian_matrix(plane.shape[0], sigma) @ plane @ gaussian_matrix(plane.shape[1], sigma).T


@functools.lru_cache(2048)
def gaussian_matrix(n, sigma):
    """Returns the matrix (n × n) that blurs a column of n pixels."""
    radius = math.ceil(4 * sigma)
    k = np.arange(-radius, radius + 1)
    weights = np.exp(-0.5 * (k / sigma) ** 2)
    matrix = np.zeros((n, n))
    for weight, offset in zip(weights / weights.sum(), k):
        np.add.at(matrix, (np.arange(n), mirror(np.arange(n) + offset, n)), weight)
    return matrix.astype(np.float32)


@functools.lru_cache(2048)
def resampling_matrix(n, step):
    """Returns the matrix that samples a column of n pixels every `step` px.

    It interpolates by cubics (Catmull and Rom). If `step` exceeds 1, a Gaussian first removes
    detail that is too fine for the coarser grid.
    """
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
    """Returns the image sampled every `step` px, or every `step_x` px along x."""
    return resampling_matrix(image.shape[0], step) @ image @ resampling_matrix(image.shape[1], step_x or step).T


def normalise(plane):
    """Returns the plane less its local mean, divided by its local deviation."""
    level = plane - gaussian(plane, DRIFT)
    deviation = np.sqrt(np.maximum(gaussian(level * level, CONTRAST), 0))
    return level / (deviation + 0.1 * deviation.mean() + 1e-12)


def framed(plane, unit):
    """Returns the plane, continued by reflection to multiples of `unit` at right and bottom."""
    rows, columns = (mirror(np.arange(-(-n // unit) * unit), n) for n in plane.shape)
    return plane[np.ix_(rows, columns)]
