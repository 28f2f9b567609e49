#!/usr/bin/env python3
"""Simulates histology whose cones are known, independently of `conemosaic render`.

    scripts/simulate_cut_cells.py OUT [--set NAME ...] [--count N]

Writes N images of each set NAME (default: 12 of every set) as NAME_KK.png, 8 bit, and their cones
as NAME_KK.csv: x,y in px, 0 at the centre of the top-left pixel, only cones inside the image. Needs
numpy and OpenCV. The same name always gives the same image.

The images serve to judge the program: no weights, thresholds or constants are fitted to them. But
they showed which kinds of image were missing from training. They share nothing with `render`, which
draws discs one by one. Here the plane is divided among cells:

- Mosaic: random points, moved by weighted Lloyd steps so that the spacing grows slowly across the
  image, then by random jitter.
- Cells: a cell is the region that is nearer to its centre than to any other (its Voronoi cell, with
  a gap along the walls) and within its radius. So packed cells are polygons, and cells apart are
  discs. Rods fill the space that cones leave.
- Grey values: they differ from cell to cell. Cells and background have texture. The walls may be
  stained. Interference contrast adds the slope of the cells' relief in some direction.
- Recording: uneven staining and illumination, blur of the lens, noise, 8 bit.

The sets show cells packed as at the foveal centre, with dark walls; dark cells; cells outlined on a
grey background, darker or brighter than it; among rods, cells that are bright and outlined, or
dark; and interference contrast.
"""
from typing import NamedTuple

import cv2
import numpy as np

from simulate_coherent import distance_from_a_place, inside, lloyd, main


class Look(NamedTuple):
    """Ranges from which the properties of an image are drawn.

    Lengths are in spacings. In the scale of grey values, cells are 0, and the background lies
    between −1 and 1.
    """
    spacing: tuple          # least spacing in the image, px
    radius: tuple           # radius of the cells
    size: float             # standard deviation of the logarithm of the cells' radii
    ground: float           # grey value between cells
    wall: float = 0         # grey value of stained walls less that of the cell
    rods: bool = False      # whether rods fill the space between cones
    relief: float = 0       # slope of the relief over the image's standard deviation


SETS = {
    'packed':        Look((9, 13), (.46, .56), .04, -1),
    'dark':          Look((10, 18), (.36, .46), .08, 1),
    'dark-wall':     Look((12, 22), (.34, .44), .08, -.3, wall=-1),
    'bright-wall':   Look((12, 22), (.34, .44), .08, .3, wall=1),
    'rods':          Look((18, 30), (.26, .34), .08, -.8, wall=-.8, rods=True),
    'rods-dark':     Look((18, 30), (.26, .34), .08, 1, rods=True),
    'interference':  Look((10, 18), (.38, .48), .06, -1, relief=.6),
}

FINE = 2                 # points per px of the grid on which cells are drawn
MARGIN = 24              # margin that is simulated on each side of the image, px
JITTER = 0.06            # standard deviation of the cones' jitter in x and y, spacings
RATIO = (1, 1.5)         # highest density over that in the farthest corner
GAP = (.08, .15)         # gap between cells, spacings
ROD = (.08, .11)         # radius of a rod, spacings
CELL_GREY = 0.04         # standard deviation of the cells' grey values
WALL = (.05, .08)        # standard deviation of a wall's profile, spacings
EDGE = (.015, .04)       # softness of a cell's edge, spacings
TEXTURE = (.1, .33)      # standard deviation of the texture
GRAIN = (.03, .08)       # width of the texture's grain, spacings
STAINING = 0.2           # relative standard deviation of the contrast
ILLUMINATION = 0.5       # standard deviation of the illumination over that of the cells' pattern
BLUR = (.03, .09)        # width of the lens's blur, spacings
NOISE = (.05, .2)        # standard deviation of the noise over that of the pattern


def with_rods(cones, radii, spacing, shape, rng):
    """Returns all cells, the cones first, and their radii.

    Rods are points of a jittered lattice that have enough space between the cones.
    """
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
    """Returns for each point of the grid its cell, and its depth inside the edge, in grid steps."""
    nearest, second = np.full(shape, np.inf, np.float32), np.full(shape, np.inf, np.float32)
    owner = np.zeros(shape, int)
    # measured from discs of a common size, so that small cells do not lose area to large ones
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
    """Returns the plane blurred by a Gaussian."""
    return cv2.GaussianBlur(plane, (0, 0), width)


def unit(plane):
    """Returns the plane divided by its standard deviation."""
    return plane / plane.std()


def simulate(look, rng):
    """Returns an image, and the cones inside it in px."""
    height, width = 8 * rng.integers(25, 45, 2)
    shape = FINE * (height + 2 * MARGIN), FINE * (width + 2 * MARGIN)
    outwards = distance_from_a_place(shape, rng)
    s = FINE * rng.uniform(*look.spacing)
    spacing = s * (1 + (np.sqrt(rng.uniform(*RATIO)) - 1) * outwards)
    cones = lloyd(spacing, rng)
    radii = rng.uniform(*look.radius) * spacing[cones[:, 1], cones[:, 0]] * np.exp(look.size * rng.standard_normal(len(cones)))
    cones = cones + rng.normal(0, JITTER * s, cones.shape)
    cells, radii = with_rods(cones, radii, s, shape, rng) if look.rods else (cones, radii)
    gap = 0 if look.rods else rng.uniform(*GAP) * s  # rods are already apart
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
