#!/usr/bin/env python3
"""Simulated confocal images whose cones are known, for a judgement that does not depend on `conemosaic render`.

    scripts/simulate_coherent.py OUT [--set NAME ...] [--count N]

Writes N images of each set NAME (default: 12 of every set) as NAME_KK.png, 8 bit, and their cones as NAME_KK.csv: x,y in px, 0 at
the centre of the top-left pixel, cones inside the image only. Needs numpy and OpenCV. The same name is always the same image.

No weights, thresholds or constants are fitted to these images, so that they judge. Nothing is shared with `render`, which adds up spots of
light. Here light has a phase, as in a scanning ophthalmoscope whose source is coherent:

- The mosaic: random points, then Lloyd steps weighted so that spacing grows linearly from a place in the image outwards.
- Each cone reflects from two layers (the ends of its outer segment), whose amplitudes scatter log-normally and whose difference in
  phase wanders from frame to frame: cones differ in brightness, and some nearly vanish. Tissue everywhere reflects a little,
  with a random phase (speckle).
- Fields add up, not intensities: neighbours in phase run together, in opposite phase a dark line parts them. How much of that
  is left after several frames is a matter of how far phases wander.
- Light leaves a cone as a Gaussian mode. The eye's pupil passes amplitudes up to a cut-off (its spot has rings, as Airy's), and
  defocus turns their phases. The intensity is blurred by the pinhole and by what registration of the frames leaves over.
- Lines of a frame are shifted by residual movements of the eye.
- A constant background, uneven illumination, sometimes a square root as compression, noise as of photons and of the camera, 8 bit.

The sets: the centre of the fovea, where density falls 3:1 within the image, the parafovea, and cones well apart as in the
periphery (without rods between them); clear, unless the name says how hard they are.
"""
import argparse
import multiprocessing
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np


class Conditions(NamedTuple):
    """Ranges that an image's values are drawn from. Lengths are in spacings, at the median of the image's cones."""
    spacing: tuple          # where it is least, px
    ratio: float            # of the highest density to that in the farthest corner
    pupil: tuple            # radius: the frequency that amplitudes are cut off at, cycles a spacing
    defocus: tuple          # wave-front error at the pupil's edge, waves
    scatter: tuple          # standard deviation of the logarithm of cones' amplitudes
    wander: float           # standard deviation of a cone's phase over the frames, rad
    haze: float             # light of the tissue, as part of that of a median cone's first layer
    noise: tuple            # standard deviation of photon noise at mean intensity, as part of it


SETS = {
    'fovea':            Conditions((5.0, 5.7), 3.0, (1.2, 1.6), (0.0, 0.2), (.15, .35), 2.5, .05, (.05, .15)),
    'fovea-noisy':      Conditions((5.0, 5.7), 3.0, (1.1, 1.4), (0.0, 0.4), (.20, .45), 2.5, .05, (.15, .40)),
    'fovea-medium':     Conditions((5.0, 5.7), 3.0, (1.05, 1.25), (0.0, 0.3), (.20, .40), 1.0, .15, (.10, .25)),
    'parafovea':        Conditions((8.0, 8.7), 1.3, (1.1, 1.6), (0.0, 0.3), (.15, .35), 2.5, .05, (.05, .30)),
    'parafovea-medium': Conditions((7.0, 7.7), 1.5, (1.0, 1.3), (0.0, 0.3), (.30, .50), 1.0, .15, (.10, .40)),
    'parafovea-hard':   Conditions((8.0, 8.7), 1.5, (0.9, 1.2), (0.0, 0.5), (.40, .70), 1.0, .15, (.20, .80)),
    'periphery':        Conditions((10.0, 10.7), 1.2, (1.6, 2.4), (0.0, 0.3), (.30, .60), 2.5, .05, (.10, .30)),
}

FINE = 3                 # light is computed on a grid of so many points a px
MARGIN = 20              # so much more than the image is simulated on each side, px
LLOYD_STEPS = 15
FRAMES = 6
SECOND_LAYER = 0.5       # its median amplitude, as part of the first layer's
LAYERS_WANDER = 0.6      # standard deviation of their difference in phase over the frames, rad
MODE = 0.11              # standard deviation of the amplitude that leaves a cone, spacings
PINHOLE = 0.12           # standard deviation of the blur of the intensity, spacings
PUPIL_EDGE = 0.06        # its softness, as part of the pupil's radius
MOVEMENT_LINES = 13      # the eye's velocity changes after so many lines, px
MOVEMENT = 0.06          # standard deviation of its shift within that time, px
BACKGROUND = 0.25        # as part of the mean of the cones' light
ILLUMINATION = 0.3       # standard deviation of the logarithm of the illumination
COMPRESSED = 0.3         # so many of the images are square roots


def lloyd(spacing, rng):
    """Cones on a grid that holds the spacing wanted at each of its points (grid steps): one (x, y) a row."""
    density = 2 / (np.sqrt(3) * spacing ** 2)
    start = rng.choice(density.size, round(density.sum()), replace=False, p=(density / density.sum()).ravel())
    y, x = np.divmod(start, density.shape[1])
    rows, columns = (axis.astype(float) for axis in np.indices(density.shape))
    weight = density ** 2  # in the plane, points come to stand as the square root of the weight
    for _ in range(LLOYD_STEPS):
        elsewhere = np.ones(density.shape, np.uint8)
        elsewhere[np.rint(y).astype(int), np.rint(x).astype(int)] = 0
        cells = cv2.distanceTransformWithLabels(elsewhere, cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL)[1].ravel()
        mass, x, y = (np.bincount(cells, (weight * of).ravel())[1:] for of in (1, columns, rows))
        x, y = x / mass, y / mass
    return np.rint(np.stack([x, y], 1)).astype(int)


def random_phase(shape, spread, rng):
    return np.exp(1j * rng.normal(0, spread, shape))


def averaged_frames(cones, shape, spacing, conditions, rng):
    """The intensity of all frames on the fine grid; `spacing` is the median, in steps of that grid."""
    pupil, defocus, scatter = (rng.uniform(*r) for r in (conditions.pupil, conditions.defocus, conditions.scatter))
    first = np.exp(scatter * rng.standard_normal(len(cones)))
    second = SECOND_LAYER * first * np.exp(0.5 * rng.standard_normal(len(cones)))
    cone_phase, layers_phase = (np.exp(2j * np.pi * rng.random(len(cones))) for _ in range(2))
    f = spacing * np.hypot(np.fft.fftfreq(shape[0])[:, None], np.fft.fftfreq(shape[1]))
    aperture = (1 - np.tanh((f / pupil - 1) / (2 * PUPIL_EDGE))) / 2
    transfer = aperture * np.exp(2j * np.pi * defocus * (f / pupil) ** 2 - 2 * np.pi ** 2 * MODE ** 2 * f ** 2)
    haze = np.sqrt(conditions.haze / np.sqrt(3)) / spacing * (rng.standard_normal(shape) + 1j * rng.standard_normal(shape))
    rows, columns = (axis.astype(np.float32) for axis in np.indices(shape))
    total = np.zeros(shape, np.float32)
    for _ in range(FRAMES):
        light = first + second * layers_phase * random_phase(len(cones), LAYERS_WANDER, rng)
        field = haze * random_phase(shape, conditions.wander, rng)
        field[cones[:, 1], cones[:, 0]] += light * cone_phase * random_phase(len(cones), conditions.wander, rng)
        intensity = np.abs(np.fft.ifft2(np.fft.fft2(field) * transfer)) ** 2
        intensity = cv2.GaussianBlur(intensity.astype(np.float32), (0, 0), PINHOLE * spacing)
        knots = np.arange(0, shape[0] + FINE * MOVEMENT_LINES, FINE * MOVEMENT_LINES)
        shift = np.cumsum(rng.normal(0, FINE * MOVEMENT, len(knots)))
        shift = np.interp(np.arange(shape[0]), knots, shift - shift.mean()).astype(np.float32)
        total += cv2.remap(intensity, columns + shift[:, None], rows, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return total


def recorded(light, noise, rng):
    """What the camera makes of it: 8 bit."""
    drift = cv2.GaussianBlur(rng.standard_normal(light.shape), (0, 0), min(light.shape) / 5)
    image = (light / light.mean() + BACKGROUND) * np.exp(ILLUMINATION * drift / drift.std())
    if rng.random() < COMPRESSED:
        image = np.sqrt(image)
    image = rng.poisson(image / image.mean() / noise ** 2) * noise ** 2 + rng.normal(0, noise / 2, image.shape)
    black, white = np.percentile(image, [0.5, 99.7])
    return np.clip(10 + 230 * (image - black) / (white - black), 0, 255).astype(np.uint8)


def distance_from_a_place(shape, rng):
    """From 0 at some place in the middle to 1 in the corner farthest from it."""
    centre = shape * rng.uniform(0.2, 0.8, 2)
    distance = np.hypot(*(axis - c for axis, c in zip(np.indices(shape), centre)))
    return distance / distance.max()


def inside(points, height, width):
    """Those of the points x, y, px, that lie in the image."""
    return points[((points > -0.5) & (points < np.array([width, height]) - 0.5)).all(1)]


def simulate(conditions, rng):
    """Image, and the cones inside it, px."""
    height, width = 8 * rng.integers(25, 41, 2)
    shape = FINE * (height + 2 * MARGIN), FINE * (width + 2 * MARGIN)
    outwards = distance_from_a_place(shape, rng)
    spacing = FINE * rng.uniform(*conditions.spacing) * (1 + (np.sqrt(conditions.ratio) - 1) * outwards)
    cones = lloyd(spacing, rng)
    median = np.median(spacing[cones[:, 1], cones[:, 0]])
    light = averaged_frames(cones, shape, median, conditions, rng)
    light = cv2.resize(light, None, fx=1 / FINE, fy=1 / FINE, interpolation=cv2.INTER_AREA)[MARGIN:-MARGIN, MARGIN:-MARGIN]
    image = recorded(light, rng.uniform(*conditions.noise), rng)
    return image, inside((cones + 0.5) / FINE - 0.5 - MARGIN, height, width)


def write(job):
    out, simulate, conditions, name, number = job
    cv2.setNumThreads(1)  # images are made side by side instead
    image, cones = simulate(conditions, np.random.default_rng([number, *name.encode()]))
    stem = f'{out}/{name}_{number:02}'
    cv2.imwrite(f'{stem}.png', image)
    np.savetxt(f'{stem}.csv', cones, '%.3f', ',', header='x,y', comments='')


def main(description, sets, simulate):
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('out', metavar='OUT', type=Path)
    parser.add_argument('--set', nargs='+', choices=sets, default=list(sets), metavar='NAME', help=', '.join(sets))
    parser.add_argument('--count', type=int, default=12, metavar='N')
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    jobs = [(options.out, simulate, sets[name], name, k) for name in options.set for k in range(options.count)]
    with multiprocessing.Pool() as pool:
        pool.map(write, jobs, chunksize=1)


if __name__ == '__main__':
    main(__doc__, SETS, simulate)
