#!/usr/bin/env python3
"""Simulated histology whose cones are known, for a judgement that does not depend on `conemosaic render`.

    scripts/simulate_cut_cells.py OUT [--set NAME ...] [--count N]

Writes N images of each set NAME (default: 12 of every set) as NAME_KK.png, 8 bit, and their cones as NAME_KK.csv: x,y in px, 0 at
the centre of the top-left pixel, cones inside the image only. Needs numpy and OpenCV. The same name is always the same image.

No weights, thresholds or constants are fitted to these images, so that they judge; but they showed which kinds of image training lacked. Nothing is shared with `render`, which draws
discs one by one. Here the plane is divided among cells:

- The mosaic: random points, then Lloyd steps weighted so that spacing grows slowly across the image, then jitter.
- A cell is what is nearer to its centre than to any other (its Voronoi cell, with a gap along the walls) and no farther away than
  its radius: where cells are packed they are polygons, where they are not, discs. Rods fill the room that cones leave.
- Cells differ in grey, and have texture as the ground has. Their walls may be stained. Interference contrast adds the slope of their
  relief in some direction.
- Uneven staining and illumination, the blur of the lens, noise, 8 bit.

The sets: cells packed as at the foveal centre with dark walls between them; stained dark; outlined on a grey ground, darker or
brighter than it; bright and outlined or dark among rods; in interference contrast.
"""
from typing import NamedTuple

import cv2
import numpy as np

from simulate_coherent import distance_from_a_place, inside, lloyd, main


class Look(NamedTuple):
    """Ranges that an image's values are drawn from. Lengths are in spacings; greys in the scale in which cells are 0 and the
    ground lies between −1 and 1."""
    spacing: tuple          # where it is least, px
    radius: tuple           # of cells
    size: float             # standard deviation of the logarithm of cells' radii
    ground: float           # grey between cells
    wall: float = 0         # grey of stained walls less that of the cell
    rods: bool = False
    relief: float = 0       # slope of the relief, as part of the image's standard deviation


SETS = {
    'packed':        Look((9, 13), (.46, .56), .04, -1),
    'dark':          Look((10, 18), (.36, .46), .08, 1),
    'dark-wall':     Look((12, 22), (.34, .44), .08, -.3, wall=-1),
    'bright-wall':   Look((12, 22), (.34, .44), .08, .3, wall=1),
    'rods':          Look((18, 30), (.26, .34), .08, -.8, wall=-.8, rods=True),
    'rods-dark':     Look((18, 30), (.26, .34), .08, 1, rods=True),
    'interference':  Look((10, 18), (.38, .48), .06, -1, relief=.6),
}

FINE = 2                 # cells are drawn on a grid of so many points a px
MARGIN = 24              # so much more than the image is simulated on each side, px
JITTER = 0.06            # of cones, standard deviation in x and y, spacings
RATIO = (1, 1.5)         # of the highest density to that in the farthest corner
GAP = (.08, .15)         # between cells, spacings
ROD = (.08, .11)         # radius, spacings
CELL_GREY = 0.04         # standard deviation
WALL = (.05, .08)        # standard deviation of a wall's profile, spacings
EDGE = (.015, .04)       # softness of a cell's edge, spacings
TEXTURE = (.1, .33)      # standard deviation
GRAIN = (.03, .08)       # its width, spacings
STAINING = 0.2           # standard deviation of the contrast, relative
ILLUMINATION = 0.5       # standard deviation of the ground over that of the cells' pattern
BLUR = (.03, .09)        # spacings
NOISE = (.05, .2)        # of the pattern's standard deviation


def with_rods(cones, radii, spacing, shape, rng):
    """All cells, the cones first, and their radii: rods are a jittered lattice in what room there is."""
    radius = rng.uniform(*ROD) * spacing
    pitch = 2.1 * radius
    y, x = np.mgrid[0:shape[0]:0.87 * pitch, 0:shape[1]:pitch]
    x[1::2] += pitch / 2
    rods = np.stack([x.ravel(), y.ravel()], 1)
    rods += rng.normal(0, 0.12 * pitch, rods.shape)
    room = np.concatenate([(np.linalg.norm(some[:, None] - cones, axis=2) - radii).min(1) for some in np.array_split(rods, 20)])
    rods = rods[(room > 1.05 * radius) & (rng.random(len(rods)) < 0.9)]
    return np.concatenate([cones, rods]), np.concatenate([radii, radius * np.exp(0.1 * rng.standard_normal(len(rods)))])


def depths(cells, radii, gap, shape):
    """Whose cell each point of the grid is, and how far inside its edge it lies, in steps of the grid."""
    nearest, second = np.full(shape, np.inf, np.float32), np.full(shape, np.inf, np.float32)
    owner = np.zeros(shape, int)
    # distances from discs of a common size: small cells are not overgrown by large ones
    common = radii.min()
    for k, ((x, y), radius) in enumerate(zip(cells, radii)):
        reach = 4 * radius
        top, left = (int(max(0, side - reach)) for side in (y, x))
        part = np.s_[top:int(y + reach) + 1, left:int(x + reach) + 1]
        rows, columns = np.indices(owner[part].shape)
        distance = np.hypot(columns + left - x, rows + top - y) - (radius - common)
        closer = distance < nearest[part]
        second[part] = np.where(closer, nearest[part], np.minimum(second[part], distance))
        nearest[part] = np.where(closer, distance, nearest[part])
        owner[part][closer] = k
    depth = np.minimum((second - nearest - gap) / 2, common - nearest)
    return owner, np.where(np.isfinite(nearest), depth, -common)


def blurred(plane, width):
    return cv2.GaussianBlur(plane, (0, 0), width)


def unit(plane):
    return plane / plane.std()


def simulate(look, rng):
    """Image, and the cones inside it, px."""
    height, width = 8 * rng.integers(25, 45, 2)
    shape = FINE * (height + 2 * MARGIN), FINE * (width + 2 * MARGIN)
    outwards = distance_from_a_place(shape, rng)
    s = FINE * rng.uniform(*look.spacing)
    spacing = s * (1 + (np.sqrt(rng.uniform(*RATIO)) - 1) * outwards)
    cones = lloyd(spacing, rng)
    radii = rng.uniform(*look.radius) * spacing[cones[:, 1], cones[:, 0]] * np.exp(look.size * rng.standard_normal(len(cones)))
    cones = cones + rng.normal(0, JITTER * s, cones.shape)
    cells, radii = with_rods(cones, radii, s, shape, rng) if look.rods else (cones, radii)
    gap = 0 if look.rods else rng.uniform(*GAP) * s  # rods are set apart as they are
    owner, depth = depths(cells, radii, gap, shape)

    cell = (1 + np.tanh(depth / (rng.uniform(*EDGE) * s))) / 2
    image = look.ground * (1 - cell) + CELL_GREY * rng.standard_normal(len(cells))[owner] * cell
    image += look.wall * np.exp(-0.5 * (depth / (rng.uniform(*WALL) * s)) ** 2)
    image += rng.uniform(*TEXTURE) * unit(blurred(rng.standard_normal(shape), rng.uniform(*GRAIN) * s))
    if look.relief:
        angle = rng.uniform(0, 2 * np.pi)
        slopes = np.gradient(blurred(np.maximum(depth, -s / 8), 0.08 * s))
        image += look.relief * image.std() * unit(np.cos(angle) * slopes[1] + np.sin(angle) * slopes[0])
    drift = unit(blurred(rng.standard_normal(shape), min(shape) / 5))
    image = unit(image) * (1 + STAINING * drift) + ILLUMINATION * drift
    image = cv2.resize(blurred(image, rng.uniform(*BLUR) * s), None, fx=1 / FINE, fy=1 / FINE, interpolation=cv2.INTER_AREA)
    image = image[MARGIN:-MARGIN, MARGIN:-MARGIN]
    image = image + rng.uniform(*NOISE) * image.std() * rng.standard_normal(image.shape)
    black, white = np.percentile(image, [0.3, 99.7])
    image = np.clip(10 + 235 * (image - black) / (white - black), 0, 255).astype(np.uint8)
    return image, inside((cones + 0.5) / FINE - 0.5 - MARGIN, height, width)


if __name__ == '__main__':
    main(__doc__, SETS, simulate)
