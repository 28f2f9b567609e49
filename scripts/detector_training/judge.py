"""Detection as src/detect/learned does it, and its agreement with marks.

`look` finds the maxima of a network's output in an image. `judge` scores them for many thresholds.
`summary` chooses the constants, and writes the scores and the header of the weights.
"""
import math
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from .marks import density_spacing, inside, logistic, partners, probability, reach
from .network import see
from .plane import SPACING
from .ring import CLEAR, clarity, profiles

CANDIDATE = -4.5       # logit below which a maximum is never a cone
# least logit, and radius of suppression in spacings, of the maxima from whose upper quartile the
# image-relative threshold is counted
RELATIVE_FLOOR, RELATIVE_RADIUS = -2.5, 0.45
RADII = (0.45, 0.5, 0.55)  # radii of suppression that are tried, in spacings
# thresholds that are tried
GRIDS = {'absolute': np.arange(-2.4, 1.01, 0.1), 'relative': np.arange(0.8, 2.41, 0.1)}


class Rule(NamedTuple):
    """Rule for the logit above which a maximum is a cone."""
    # absolute: a logit; relative: a distance below the upper quartile of the stronger maxima
    kind: str
    in_noise: float    # rise of the threshold per unit of clarity that is missing


RULES = {'confocal': Rule('absolute', 0.2), 'split': Rule('relative', 0), 'histology': Rule('absolute', 0)}
START = {'absolute': -1.2, 'relative': 1.6}  # constants until they are chosen
# of constants whose mean Dice coefficients differ by less, those best on altered images are taken
TIED = 0.0001


def candidates(z, lowest):
    """Returns the maxima of 3 × 3 px, moved to the top of a parabola: x, y, logit, best first."""
    h, w = z.shape
    padded = np.pad(z.astype(np.float64), 1, constant_values=-np.inf)
    around = [padded[1 + j:1 + j + h, 1 + i:1 + i + w] for j in (-1, 0, 1) for i in (-1, 0, 1)]
    top = (z > lowest) & np.logical_and.reduce([z >= a for a in around])
    y, x = np.nonzero(top)

    def offset(a, b, c, inside):
        """Returns the place of the top of the parabola through three values, in −0.5 to 0.5."""
        with np.errstate(invalid='ignore'):
            curvature = a - 2 * b + c
            good = inside & (curvature < 0)
            return np.where(good, np.clip(0.5 * (a - c) / np.where(good, curvature, 1), -0.5, 0.5), 0)

    dx = offset(padded[y + 1, x], z[y, x], padded[y + 1, x + 2], (x > 0) & (x < w - 1))
    dy = offset(padded[y, x + 1], z[y, x], padded[y + 2, x + 1], (y > 0) & (y < h - 1))
    found = np.stack([x + dx, y + dy, z[y, x]], 1)
    return found[np.argsort(-found[:, 2], kind='stable')]


def suppress(found, radius):
    """Returns the maxima that have no higher one, which is kept itself, within `radius` px."""
    if len(found) == 0:
        return found
    keep = np.ones(len(found), bool)
    pairs = cKDTree(found[:, :2]).query_pairs(radius, output_type='ndarray')
    for i, j in pairs[np.lexsort(pairs.T[::-1])]:
        if keep[i]:
            keep[j] = False
    return found[keep]


def threshold_of(found, rule, constant):
    """Returns the logit above which a maximum of this image is a cone."""
    if rule.kind == 'absolute':
        return constant
    strong = suppress(found[found[:, 2] > RELATIVE_FLOOR], RELATIVE_RADIUS * SPACING)
    return np.percentile(strong[:, 2], 75) - constant if len(strong) else np.inf


def places(found, spacing):
    """Returns the places x, y in px of the image, given maxima in px of the network."""
    return (found[:, :2] + 0.5) * spacing / SPACING - 0.5


def look(image, start, network, rule, sign, passes=3):
    """Returns all maxima, and the spacing in px at which they were found.

    From `start`, the spacing follows from the density of the cones found, in at most `passes`
    passes. In noise the threshold should rise; here the logits are lowered instead, so that one
    threshold serves all images.
    """
    following = start
    profile = profiles(image)[0] if rule.in_noise else None
    for _ in range(passes):
        spacing = following
        found = candidates(see(image, spacing, network, sign), CANDIDATE)
        if rule.in_noise:
            found[:, 2] -= rule.in_noise * max(0, CLEAR - clarity(profile, spacing))
        cones = suppress(found[found[:, 2] > threshold_of(found, rule, START[rule.kind])], 0.5 * SPACING)
        following = density_spacing(places(cones, spacing), image.shape)
        low, high = (start * math.exp(side) for side in (-0.35, 0.35))
        following = min(max(following, low, 4), high, 40)
        if abs(following / spacing - 1) < 0.03:
            break
    return found, spacing


def matched(found, marks, shape):
    """Returns which marks and cones have a partner, and which marks and cones are counted.

    A pair is counted only if neither of the two is near the border.
    """
    at = partners(marks, found, reach(marks))
    got, hit = at >= 0, np.zeros(len(found), bool)
    hit[at[got]] = True
    marks_counted, found_counted = inside(marks, shape), inside(found, shape)
    both = marks_counted[got] & found_counted[at[got]]
    marks_counted[got] = both
    found_counted[at[got]] = both
    return got, hit, marks_counted, found_counted


def dice(found, marks, shape):
    """Returns the Dice coefficient of the cones by the rule of Cunefare et al. (2017)."""
    got, hit, marks_counted, found_counted = matched(found, marks, shape)
    tp, fn, fp = (hit & found_counted).sum(), (~got & marks_counted).sum(), (~hit & found_counted).sum()
    return 2 * tp / max(1, 2 * tp + fn + fp)


def judge(seen, samples, rule, constants, radius):
    """Returns the Dice coefficients, constants × samples.

    Suppression comes before the threshold: a maximum below the threshold is lower than any above
    it, so it would not have suppressed one that stays.
    """
    out = np.zeros((len(constants), len(samples)))
    for column, sample in enumerate(samples):
        found, spacing = seen[sample.name]
        kept = suppress(found, radius * SPACING)
        where = places(kept, spacing)
        zero = threshold_of(found, rule, 0)
        for row, constant in enumerate(constants):
            threshold = constant if rule.kind == 'absolute' else zero - constant
            out[row, column] = dice(where[kept[:, 2] > threshold], sample.marks, sample.image.shape)
    return out


def calibration(seen, samples, rule, constant, radius):
    """Returns the constants of the calibration for the header, and how reliable it is.

    The probability that a maximum is a marked cone is 1/(1 + exp(−(offset + slope · x))), where x
    is the logit less the image's threshold. The fit is to maxima in images left out of training
    that are at most 1 below the threshold. Reliability is in ten bins of equal count.
    """
    x, hit = [], []
    for sample in samples:
        found, spacing = seen[sample.name]
        threshold = threshold_of(found, rule, constant)
        kept = suppress(found, radius * SPACING)
        kept = kept[kept[:, 2] > threshold - 1]
        _, right, _, counted = matched(places(kept, spacing), sample.marks, sample.image.shape)
        x.append((kept[:, 2] - threshold)[counted])
        hit.append(right[counted])
    x, hit = np.concatenate(x), np.concatenate(hit).astype(float)
    offset, slope = fitted = logistic(x, hit)
    p = probability(fitted, x)
    edges = np.quantile(p, np.linspace(0, 1, 11))
    bins = np.clip(np.searchsorted(edges, p, side='right') - 1, 0, 9)
    table = [(int((bins == b).sum()), float(p[bins == b].mean()), float(hit[bins == b].mean())) for b in range(10)
             if (bins == b).any()]
    error = sum(n * abs(said - was) for n, said, was in table) / len(p)
    accepted = x > 0
    return {'calibration_offset': offset, 'calibration_slope': slope, 'calibration_of': 'logit minus threshold'}, {
        'expected_calibration_error': error, 'reliability': table,
        'accepted_said': float(p[accepted].mean()), 'accepted_was': float(hit[accepted].mean())}


def summary(seen, disturbed, samples, folds, rule):
    """Returns the scores of all seeds, and the header of the weights.

    The header has the constants that are best over all seeds, and the best seed. Among constants
    that are equally good, those best on altered images are taken. `disturbed` holds the results of
    the first seed on altered images, by the names of image and alteration.
    """
    choices = [(round(float(c), 3), r) for r in RADII for c in GRIDS[rule.kind]]
    scores = np.array([np.concatenate([judge(part, samples, rule, GRIDS[rule.kind], r) for r in RADII]) for part in seen])
    member = np.array([[s.subject in fold for s in samples] for fold in folds])
    by_fold = lambda values: np.stack([values[..., m].mean(-1) for m in member], -1)
    folded = by_fold(scores)  # seeds × choices × folds
    mean = folded.mean(0)
    by_name = {s.name: s for s in samples}

    def score(sample, found, spacing, constant, radius, shape=None, factor=1):
        """Returns the Dice coefficient; a scaled image has its own `shape` and `factor`."""
        kept = suppress(found[found[:, 2] > threshold_of(found, rule, constant)], radius * SPACING)
        return dice(places(kept, spacing), (sample.marks + 0.5) * factor - 0.5, shape or sample.image.shape)

    def chosen(kept):
        """Returns the index of the constants that are best on the folds `kept`."""
        means = mean[:, kept].mean(1)
        subjects = {subject for k in kept for subject in folds[k]}
        shown = [(by_name[name], *look) for (name, _), look in disturbed.items() if by_name[name].subject in subjects]
        when_disturbed = lambda c: np.mean([score(sample, found, spacing, *choices[c], shape, factor)
                                            for sample, found, spacing, shape, factor in shown])
        return int(max(np.flatnonzero(means > means.max() - TIED), key=when_disturbed))

    every = list(range(len(folds)))
    pick = chosen(every)
    constant, radius = choices[pick]
    # constants for a fold are chosen on the other folds
    others = [chosen([k for k in every if k != left_out]) for left_out in every]
    nested = np.array([[folded[s, others[k], k] for k in every] for s in range(len(seen))])
    seed = int(folded[:, pick].mean(1).argmax())
    baseline = np.array([dice(s.classical, s.marks, s.image.shape) for s in samples])
    subjects = sorted({s.subject for s in samples})
    of = {u: np.array([s.subject == u for s in samples]) for u in subjects}
    error = np.log([[part[s.name][1] / s.true for s in samples] for part in seen])
    start = np.log([s.start / s.true for s in samples])
    rms = lambda values: float(np.sqrt((values ** 2).mean()))
    words, reliable = calibration(seen[seed], samples, rule, constant, radius)
    losses = {}
    for (name, change), (found, spacing, shape, factor) in disturbed.items():
        sample = by_name[name]
        losses.setdefault(change, []).append(score(sample, found, spacing, constant, radius, shape, factor)
                                             - score(sample, *seen[0][name], constant, radius))
    result = {
        'dice_by_seed': folded[:, pick].mean(1).tolist(), 'nested_by_seed': nested.mean(1).tolist(),
        'nested_by_fold': nested.mean(0).tolist(), 'by_fold': mean[pick].tolist(),
        'by_subject': {u: float(scores[:, pick][:, m].mean()) for u, m in of.items()},
        'mean_over_images': float(scores[:, pick].mean()),
        'best_threshold_of_every_image': float(by_fold(scores.max(1)).mean()),
        'classical_by_fold': by_fold(baseline).tolist(),
        'classical_by_subject': {u: float(baseline[m].mean()) for u, m in of.items()},
        'classical_mean_over_images': float(baseline.mean()),
        'change_when_disturbed': {k: float(np.mean(v)) for k, v in losses.items()},
        'spacing_rms': rms(error), 'start_rms': rms(start), 'off_by_15': float((abs(error) > 0.15).mean()),
        'folds': folds,
    } | reliable
    return result, {
        'threshold': constant, 'suppression': radius, 'relative_floor': RELATIVE_FLOOR, 'relative_radius': RELATIVE_RADIUS,
        'threshold_in_noise': rule.in_noise, 'seed': seed + 1, 'classical_dice': f'{by_fold(baseline).mean():.4f}'} | words
