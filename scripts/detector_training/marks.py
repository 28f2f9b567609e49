"""Marks, the cones that match them by the rule of Cunefare et al. (2017), and their spacing.

It also holds the small tools that several training scripts share: folds of subjects, logistic
regression, reliability, and the bytes of weights.
"""
import math
import os

import numpy as np
from scipy.spatial import cKDTree

BORDER = 7        # width of the border, in px, that is left out
FRACTION = 0.75   # largest distance of a cone from its mark, in median neighbour distances


def read_marks(image, origin):
    """Returns the marks x, y of the image NAME.png, in px from 0, read from NAME_coords.csv.

    `origin` is the coordinate of the first pixel in the file.
    """
    marks = np.genfromtxt(image[:-4] + '_coords.csv', delimiter=',')[:, :2] - origin
    return marks[~np.isnan(marks).any(1)]


def subject(image):
    """Returns the subject: the first two parts of an image's name between underscores."""
    return '_'.join(os.path.basename(image).split('_')[:2])


def inside(points, shape):
    """Returns which points lie inside the border that is left out."""
    h, w = shape
    return ((points >= BORDER - 0.5) & (points < [w - BORDER - 0.5, h - BORDER - 0.5])).all(1)


def group(image, marked):
    """Returns the name of the group of images that is left out together.

    It is the subject, or the GROUP of a simulated image, GROUP_KIND_NUMBER.png.
    """
    return subject(image) if marked else 'simulated ' + os.path.basename(image).split('_')[0]


def folds(rows, count):
    """Returns, for each of `count` folds of subjects, the other rows and its own rows."""
    subjects = sorted({row.subject for row in rows})
    np.random.default_rng(0).shuffle(subjects)
    parts = [set(subjects[k::count]) for k in range(count)]
    return [([row for row in rows if row.subject not in part], [row for row in rows if row.subject in part]) for part in parts]


def floats(tensors):
    """Returns the bytes of tensors as the program reads them: 32 bits, little endian."""
    return b''.join(np.asarray(tensor).astype('<f4').tobytes() for tensor in tensors)


def density_spacing(points, shape):
    """Returns the spacing in px of a hexagonal lattice with the density of the points."""
    h, w = shape
    return math.sqrt(2 * (w - 2 * BORDER) * (h - 2 * BORDER) / (math.sqrt(3) * max(1, inside(points, shape).sum())))


def reach(marks):
    """Returns the largest distance of a cone from its mark, in px."""
    return FRACTION * np.median(cKDTree(marks).query(marks, k=2)[0][:, 1])


def partners(marks, found, reach):
    """Returns for every mark the index of its cone, or −1 if it has none.

    It is the nearest cone, if that is within `reach` and no other mark is nearer to it.
    """
    at = np.full(len(marks), -1)
    if len(found) and len(marks):
        distance, nearest = cKDTree(found).query(marks)
        order = np.lexsort((distance, nearest))
        order = order[distance[order] <= reach]
        first = order[np.unique(nearest[order], return_index=True)[1]]
        at[first] = nearest[first]
    return at


def logistic(columns, hit):
    """Returns the offset and slopes of a logistic regression, by Newton's method."""
    design = np.column_stack([np.ones(len(hit)), columns])
    beta = np.zeros(design.shape[1])
    for _ in range(50):
        p = 1 / (1 + np.exp(-(design @ beta)))
        step = np.linalg.solve((design * (p * (1 - p))[:, None]).T @ design, design.T @ (hit - p))
        beta += step
        if abs(step).max() < 1e-9:
            break
    return beta


def probability(beta, columns):
    """Returns the probability of a hit for each row, by a logistic regression."""
    return 1 / (1 + np.exp(-(np.column_stack([np.ones(len(columns)), columns]) @ beta)))


def reliability(p, hit):
    """Returns the table of reliability in ten bins of equal width, and the calibration error.

    A row of the table has the lower end of the bin, the count, the mean probability and the share
    of hits. The error is the mean difference of the last two, weighted by count.
    """
    bins = np.minimum((10 * p).astype(int), 9)
    rows = [(b / 10, (bins == b).sum(), p[bins == b].mean(), hit[bins == b].mean()) for b in np.unique(bins)]
    return rows, sum(n * abs(said - was) for _, n, said, was in rows) / len(p)
