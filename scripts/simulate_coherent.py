#!/usr/bin/env python3
"""Simulates confocal images whose cones are known, independently of `conemosaic render`.

    scripts/simulate_coherent.py OUT [--set NAME ...] [--count N]

Writes N images of each set NAME (default: 12 of every set) as NAME_KK.png, 8 bit, and their cones
as NAME_KK.csv: x,y in px, 0 at the centre of the top-left pixel, only cones inside the image. Needs
numpy and OpenCV. The same name always gives the same image.

The images serve to judge the program: no weights, thresholds or constants are fitted to them. They
share nothing with `render`, which adds up spots of light. Here light has a phase, as in a scanning
ophthalmoscope whose source is coherent:

- Mosaic: random points, moved by weighted Lloyd steps so that the spacing grows linearly outwards
  from a place in the image.
- Cones: each reflects from two layers (the ends of its outer segment). The amplitudes scatter
  log-normally, and the difference in phase changes from frame to frame. So cones differ in
  brightness, and some nearly vanish. Tissue everywhere reflects a little, with a random phase
  (speckle).
- Interference: fields add up, not intensities. Neighbours in phase merge; a dark line separates
  neighbours in opposite phase. The more the phases change between frames, the less of this is left
  in the mean of several frames.
- Optics: light leaves a cone as a Gaussian mode. The pupil of the eye passes amplitudes up to a
  cut-off frequency (its spot has rings like Airy's), and defocus turns their phases. The intensity
  is blurred by the pinhole and by errors in the registration of the frames.
- Movement: residual eye movements shift the lines of a frame.
- Recording: a constant background, uneven illumination, sometimes compression by a square root,
  photon and camera noise, 8 bit.

The sets show the centre of the fovea, where the density falls 3:1 within the image; the parafovea;
and cones far apart, as in the periphery (without rods between them). Images are clear unless the
name of the set says how difficult they are.
"""
import argparse
import multiprocessing
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np


class Conditions(NamedTuple):
    """Ranges from which the properties of an image are drawn.

    Lengths are in spacings, at the median of the image's cones.
    """
    spacing: tuple          # least spacing in the image, px
    ratio: float            # highest density over that in the farthest corner
    pupil: tuple            # cut-off frequency of amplitudes, cycles per spacing
    defocus: tuple          # wave-front error at the pupil's edge, waves
    scatter: tuple          # standard deviation of the logarithm of cones' amplitudes
    wander: float           # standard deviation of a cone's phase over the frames, rad
    haze: float             # light of the tissue over that of a median cone's first layer
    noise: tuple            # standard deviation of photon noise over the mean intensity


SETS = {
    'fovea':            Conditions((5.0, 5.7), 3.0, (1.2, 1.6), (0.0, 0.2), (.15, .35), 2.5, .05, (.05, .15)),
    'fovea-noisy':      Conditions((5.0, 5.7), 3.0, (1.1, 1.4), (0.0, 0.4), (.20, .45), 2.5, .05, (.15, .40)),
    'fovea-medium':     Conditions((5.0, 5.7), 3.0, (1.05, 1.25), (0.0, 0.3), (.20, .40), 1.0, .15, (.10, .25)),
    'parafovea':        Conditions((8.0, 8.7), 1.3, (1.1, 1.6), (0.0, 0.3), (.15, .35), 2.5, .05, (.05, .30)),
    'parafovea-medium': Conditions((7.0, 7.7), 1.5, (1.0, 1.3), (0.0, 0.3), (.30, .50), 1.0, .15, (.10, .40)),
    'parafovea-hard':   Conditions((8.0, 8.7), 1.5, (0.9, 1.2), (0.0, 0.5), (.40, .70), 1.0, .15, (.20, .80)),
    'periphery':        Conditions((10.0, 10.7), 1.2, (1.6, 2.4), (0.0, 0.3), (.30, .60), 2.5, .05, (.10, .30)),
}

FINE = 3                 # points per px of the grid on which light is computed
MARGIN = 20              # margin that is simulated on each side of the image, px
LLOYD_STEPS = 15
FRAMES = 6
SECOND_LAYER = 0.5       # median amplitude of the second layer over that of the first
LAYERS_WANDER = 0.6      # standard deviation over the frames of the layers' phase difference, rad
MODE = 0.11              # standard deviation of the amplitude that leaves a cone, spacings
PINHOLE = 0.12           # standard deviation of the blur of the intensity, spacings
PUPIL_EDGE = 0.06        # softness of the pupil's edge over the pupil's radius
MOVEMENT_LINES = 13      # lines after which the velocity of the eye changes, px
MOVEMENT = 0.06          # standard deviation of the shift within that time, px
BACKGROUND = 0.25        # background over the mean of the cones' light
ILLUMINATION = 0.3       # standard deviation of the logarithm of the illumination
COMPRESSED = 0.3         # share of the images that are compressed by a square root


def lloyd(spacing, rng):
    """Returns cones on a grid, one (x, y) per row, in grid steps.

    `spacing` holds the spacing that is wanted at each point of the grid, in grid steps.
    """
    density = 2 / (np.sqrt(3) * spacing ** 2)
    start = rng.choice(density.size, round(density.sum()), replace=False, p=(density / density.sum()).ravel())
    y, x = np.divmod(start, density.shape[1])
    rows, columns = (axis.astype(float) for axis in np.indices(density.shape))
    # in the plane, Lloyd's points get a density that is the square root of the weight
    weight = density ** 2
    for _ in range(LLOYD_STEPS):
        elsewhere = np.ones(density.shape, np.uint8)
        elsewhere[np.rint(y).astype(int), np.rint(x).astype(int)] = 0
        cells = cv2.distanceTransformWithLabels(elsewhere, cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL)[1].ravel()
        mass, x, y = (np.bincount(cells, (weight * of).ravel())[1:] for of in (1, columns, rows))
        x, y = x / mass, y / mass
    return np.rint(np.stack([x, y], 1)).astype(int)


def random_phase(shape, spread, rng):
    """Returns complex numbers of modulus 1 whose phases scatter by `spread`, in rad."""
    return np.exp(1j * rng.normal(0, spread, shape))


def averaged_frames(cones, shape, spacing, conditions, rng):
    """Returns the sum of the frames' intensity; `spacing` is the median one, in grid steps."""
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
    """Returns the image that the camera records, with 8 bits."""
    drift = cv2.GaussianBlur(rng.standard_normal(light.shape), (0, 0), min(light.shape) / 5)
    image = (light / light.mean() + BACKGROUND) * np.exp(ILLUMINATION * drift / drift.std())
    if rng.random() < COMPRESSED:
        image = np.sqrt(image)
    image = rng.poisson(image / image.mean() / noise ** 2) * noise ** 2 + rng.normal(0, noise / 2, image.shape)
    black, white = np.percentile(image, [0.5, 99.7])
    return np.clip(10 + 230 * (image - black) / (white - black), 0, 255).astype(np.uint8)


def distance_from_a_place(shape, rng):
    """Returns the distance from a random place in the middle; the farthest corner has 1."""
    centre = shape * rng.uniform(0.2, 0.8, 2)
    distance = np.hypot(*(axis - c for axis, c in zip(np.indices(shape), centre)))
    return distance / distance.max()


def inside(points, height, width):
    """Returns the points (x, y in px) that lie in the image."""
    return points[((points > -0.5) & (points < np.array([width, height]) - 0.5)).all(1)]


def simulate(conditions, rng):
    """Returns an image, and the cones inside it in px."""
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
    """Simulates and writes one image and its cones."""
    out, simulate, conditions, name, number = job
    cv2.setNumThreads(1)  # one thread each: images are made side by side
    image, cones = simulate(conditions, np.random.default_rng([number, *name.encode()]))
    stem = f'{out}/{name}_{number:02}'
    cv2.imwrite(f'{stem}.png', image)
    np.savetxt(f'{stem}.csv', cones, '%.3f', ',', header='x,y', comments='')


def main(description, sets, simulate):
    """Writes the sets of images that the command line asks for."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('out', metavar='OUT', type=Path, help='folder for the images; made if it is missing')
    parser.add_argument('--set', nargs='+', choices=sets, default=list(sets), metavar='NAME',
                        help='sets to simulate [default: all]: ' + ', '.join(sets))
    parser.add_argument('--count', type=int, default=12, metavar='N', help='images of each set [default: 12]')
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    jobs = [(options.out, simulate, sets[name], name, k) for name in options.set for k in range(options.count)]
    with multiprocessing.Pool() as pool:
        pool.map(write, jobs, chunksize=1)


if __name__ == '__main__':
    main(__doc__, SETS, simulate)
