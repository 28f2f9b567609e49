"""Marks, what matches them by the rule of Cunefare et al. 2017, and the spacing that they show."""
import math
import os

import numpy as np
from scipy.spatial import cKDTree

BORDER = 7        # px: a frame that is left out
FRACTION = 0.75   # of the median distance of neighbours: how far a cone may be from its mark


def read_marks(image, origin):
    """x, y from 0 of NAME_coords.csv beside the image NAME.png, whose first pixel is `origin`."""
    marks = np.genfromtxt(image[:-4] + '_coords.csv', delimiter=',')[:, :2] - origin
    return marks[~np.isnan(marks).any(1)]


def subject(image):
    """The first two parts of an image's name between underscores."""
    return '_'.join(os.path.basename(image).split('_')[:2])


def inside(points, shape):
    """Which are not in the frame."""
    h, w = shape
    return ((points >= BORDER - 0.5) & (points < [w - BORDER - 0.5, h - BORDER - 0.5])).all(1)


def group(image, marked):
    """What is left out together: a subject, or what stands for one among simulated images, GROUP_KIND_NUMBER.png."""
    return subject(image) if marked else 'simulated ' + os.path.basename(image).split('_')[0]


def folds(rows, count):
    """For each of `count` folds of subjects: the other rows, and its own."""
    subjects = sorted({row.subject for row in rows})
    np.random.default_rng(0).shuffle(subjects)
    parts = [set(subjects[k::count]) for k in range(count)]
    return [([row for row in rows if row.subject not in part], [row for row in rows if row.subject in part]) for part in parts]


def floats(tensors):
    """As the program reads them: 32 bits, little endian, one after the other."""
    return b''.join(np.asarray(tensor).astype('<f4').tobytes() for tensor in tensors)


def density_spacing(points, shape):
    h, w = shape
    return math.sqrt(2 * (w - 2 * BORDER) * (h - 2 * BORDER) / (math.sqrt(3) * max(1, inside(points, shape).sum())))


def reach(marks):
    """How far a cone may be from its mark, px."""
    return FRACTION * np.median(cKDTree(marks).query(marks, k=2)[0][:, 1])


def partners(marks, found, reach):
    """For every mark the index of the cone that it keeps, or −1: its nearest, if that is within reach and no mark is nearer to it."""
    at = np.full(len(marks), -1)
    if len(found) and len(marks):
        distance, nearest = cKDTree(found).query(marks)
        order = np.lexsort((distance, nearest))
        order = order[distance[order] <= reach]
        first = order[np.unique(nearest[order], return_index=True)[1]]
        at[first] = nearest[first]
    return at


def logistic(columns, hit):
    """Offset and slopes of largest likelihood, by Newton's method."""
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
    return 1 / (1 + np.exp(-(np.column_stack([np.ones(len(columns)), columns]) @ beta)))


def reliability(p, hit):
    """How many, mean probability and part of hits in ten bins of equal width, and the mean difference of the two, by count."""
    bins = np.minimum((10 * p).astype(int), 9)
    rows = [(b / 10, (bins == b).sum(), p[bins == b].mean(), hit[bins == b].mean()) for b in np.unique(bins)]
    return rows, sum(n * abs(said - was) for _, n, said, was in rows) / len(p)
