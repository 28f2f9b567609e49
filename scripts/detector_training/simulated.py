"""Simulated images for training, made by the program's `render`.

Their properties are drawn anew for every image. They show blur, noise and rods that marked images
do not show, and histology, of which no public set has marks.
"""
import csv
import glob
import os
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image

PROGRAM = os.environ.get('CONEMOSAIC') or os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'target', 'release', 'conemosaic')

OUTLINED = ('--spacing 7..20 --diameter 0.55..0.95 --size-scatter 0.03..0.15 --outline 0..3 --shading 0..0.5 --contrast 0.08..0.3 '
            '--texture 0.05..0.3 --noise 0.005..0.05 --width 280 --height 280 --gradient 1..2 --drift 0..0.3')
AMONG_RODS = ('--spacing 14..32 --diameter 0.4..0.75 --rods 4..14 --rod-contrast 0.3..1.1 --outline 0..2 --granules 0..0.4 --contrast 0.1..0.4 '
              '--texture 0.05..0.3 --noise 0.005..0.05 --width 360 --height 360 --section 0..0.4')

# number of images and options of `render` for each kind; A..B is drawn anew for every image
KINDS = {
    'confocal': (
        (60, '--modality confocal --spacing 5..12 --width 220 --height 200 --noise 0.01..0.1 --blur 0..0.28 --scatter 0.3..1 --drift 0..0.4 '
             '--contrast 0.1..0.4 --grain 0..1'),
        (50, '--preset fovea --noise 0.01..0.08 --blur 0..0.25 --scatter 0.3..1 --dim 0..0.1 --width 300 --height 260 --grain 0..1'),
        (50, '--preset fovea --contrast 0.06..0.3 --noise 0.005..0.05 --width 280 --height 300 --blur 0..0.2 --psf airy'),
        (50, '--preset parafovea --spacing 7..16 --noise 0.01..0.08 --blur 0..0.28 --vessels 0..2 --grain 0..1 --width 300 '
             '--height 300'),
        (60, '--preset parafovea --spacing 6..16 --contrast 0.03..0.2 --noise 0.005..0.05 --width 300 --height 300 --drift 0..0.4 '
             '--grain 0..1'),
        (50, '--preset periphery --spacing 14..26 --noise 0.01..0.06 --blur 0..0.15 --width 400 --height 380'),
        (50, '--preset periphery --spacing 16..28 --contrast 0.08..0.3 --noise 0.01..0.06 --width 420 --height 400 '
             '--rod-contrast 0.2..0.8'),
        (30, '--modality confocal --spacing 4.5..7 --width 160 --height 160 --noise 0.01..0.06 --blur 0..0.2 --gradient 1..3 --psf airy'),
        (40, '--modality confocal --spacing 6..14 --scatter 0.8..1.8 --noise 0.01..0.05 --width 240 --height 240 --blur 0..0.2 --missing 0..0.15'),
    ),
    'split': (
        (70, '--preset split --spacing 8..20 --noise 0.01..0.1 --blur 0..0.2 --contrast 0.05..0.3 --grain 0..1 --width 250 '
             '--height 220 --lean 0..0.5 --texture 0.1..0.5'),
        (50, '--preset split --contrast 0.03..0.15 --spacing 7..18 --noise 0.01..0.06 --width 240 --height 240 --drift 0..0.4'),
        (60, '--preset split-periphery --noise 0.01..0.08 --blur 0..0.15 --width 350 --height 330 --grain 0..1 --drift 0..0.4'),
        (30, '--modality split --polarity negative --spacing 6..14 --noise 0.01..0.08 --blur 0..0.2 --width 200 --height 200 --gradient 1..2'),
    ),
    'histology': (
        (80, '--preset histology --spacing 6..24 --noise 0.005..0.08 --blur 0..0.2 --texture 0.03..0.4 --width 320 --height 300 '
             '--diameter 0.5..0.95 --grain 0..1 --contrast 0.1..0.6'),
        (40, '--preset histology --contrast 0.05..0.3 --spacing 6..20 --noise 0.01..0.08 --width 280 --height 280 --drift 0..0.3'),
        (40, '--preset nomarski --noise 0.005..0.06 --blur 0..0.15 --width 300 --height 300'),
        (40, '--preset electron --noise 0.005..0.06 --blur 0..0.15 --width 300 --height 300'),
        (40, '--modality histology --polarity negative --spacing 6..20 --gradient 1..2 --noise 0.005..0.06 --width 250 --height 250 --drift 0..0.2'),
        (60, f'--modality histology {OUTLINED}'),
        (60, f'--modality histology --polarity negative {OUTLINED}'),
        (60, f'--modality histology {AMONG_RODS}'),
        (60, f'--modality histology --polarity negative {AMONG_RODS}'),
    ),
}
GROUPS = 6  # groups of images, in place of subjects
MODALITIES = tuple(KINDS)


def simulate(folder, modality):
    """Simulates all images of a modality as GROUP_KIND_NUMBER.png.

    GROUP_KIND_NUMBER_coords.csv has the cones that can be seen: x, y in px, counted from 0.
    """
    for kind, (count, options) in enumerate(KINDS[modality]):
        with tempfile.TemporaryDirectory() as made:
            subprocess.run([PROGRAM, 'render', '--quiet', *options.split(), '--count', str(count),
                            '--seed', str(1000 * (kind + 1)), '--out', f'{made}/s.png', '--truth', f'{made}/s.csv',
                            '--truth-of', 'seen'], check=True)
            for number in range(1, count + 1):
                source = f'{made}/s_{number:03}'
                name = f'{folder}/{number % GROUPS}_{kind}_{number}'
                with open(source + '.csv', encoding='utf8') as file, open(name + '_coords.csv', 'w', encoding='utf8') as out:
                    out.writelines(f"{row['x_px']},{row['y_px']}\n" for row in csv.DictReader(file))
                with open(source + '.png', 'rb') as file, open(name + '.png', 'wb') as out:
                    out.write(file.read())


def images(marked, made):
    """Returns the modality, the source and the paths of each set of images.

    The sets are the folders confocal and split of the folder `marked`, and one set of simulated
    images for each modality, which are made in the folder `made`.
    """
    folders = [(modality, 'marked', os.path.join(marked, modality)) for modality in ('confocal', 'split')]
    if not any(glob.glob(f'{folder}/*.png') for _, _, folder in folders):
        sys.exit(f'{marked}/confocal, {marked}/split: expected NAME.png in at least one of them, found none')
    for modality in MODALITIES:
        folders.append((modality, 'simulated', f'{made}/{modality}'))
        os.mkdir(folders[-1][2])
        simulate(folders[-1][2], modality)
    return [(modality, source, sorted(glob.glob(f'{folder}/*.png'))) for modality, source, folder in folders]


def noise(folder, count):
    """Writes images of white noise, in which there are no cones, as NUMBER.png."""
    for number in range(count):
        rng = np.random.default_rng(number)
        grey = 128 + 40 * rng.standard_normal(rng.integers(100, 400, 2))
        Image.fromarray(np.clip(grey, 0, 255).astype(np.uint8)).save(f'{folder}/{number}.png')
