"""Trains a detector on a folder of marked images of any names; `scripts/train` starts it.

Images are PNG or TIFF, in FOLDER or its subfolders. The marks of NAME.png are in NAME_coords.csv or
NAME.csv beside it or in FOLDER/marks (or --marks), or in NAME/points.csv there, as `conemosaic run`
writes it. Images of one subject must have the same group (--group), because whole groups are left
out in cross-validation. Beside the model go a card (.md) and the scores (.json).
"""
import argparse
import csv
import datetime
import json
import os
import shlex
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from PIL import Image

IMAGES = {'.png', '.tif', '.tiff'}
FEW = 6  # images below which the cross-validated score says little


def number(text):
    """Returns the number that a cell holds, or None."""
    try:
        return float(text)
    except ValueError:
        return None


def read_points(path, origin):
    """Returns x, y in px, counted from 0, of a CSV file of marks, with or without a header."""
    rows = [row for row in csv.reader(open(path, encoding='utf-8-sig')) if row]
    x, y = 0, 1
    if rows and number(rows[0][0]) is None:
        header = [cell.strip().lower() for cell in rows.pop(0)]
        pair = next((p for p in (('x_px', 'y_px'), ('x', 'y')) if set(p) <= set(header)), None)
        if not pair:
            sys.exit(f'{path}: expected columns x, y or x_px, y_px, found {", ".join(header)}')
        x, y = map(header.index, pair)
        if pair[0] == 'x_px':
            origin = 0  # as the program writes it
    points = [(number(row[x]), number(row[y])) for row in rows if len(row) > max(x, y)]
    if len(points) < len(rows) or any(None in p for p in points):
        sys.exit(f'{path}: expected two numbers in every row')
    return np.array(points, float).reshape(-1, 2) - origin


def marks_of(image, folder, marks):
    """Returns the file of the marks of an image, or None."""
    places = [marks] if marks else [image.parent, folder / 'marks']
    names = [f'{image.stem}_coords.csv', f'{image.stem}.csv', f'{image.stem}/points.csv', f'images/{image.stem}/points.csv']
    return next((p / n for p in places for n in names if (p / n).is_file()), None)


def grouping(rule):
    """Returns the function that gives the group of an image, by `rule`: prefix:N or manifest.csv:COLUMN."""
    kind, _, rest = rule.rpartition(':')
    if kind == 'prefix' and rest.isdigit():
        return lambda image: '_'.join(image.stem.split('_')[:int(rest)])
    if not os.path.isfile(kind):
        sys.exit(f'--group {rule}: expected prefix:N, or FILE.csv:COLUMN of a manifest')
    rows = list(csv.DictReader(open(kind, encoding='utf-8-sig')))
    if not rows or rest not in rows[0]:
        sys.exit(f'{kind}: has no column {rest}')
    first = next(iter(rows[0]))

    def of(image):
        """Returns the cell of the row whose identifier is the longest part of the name."""
        fits = [row for row in rows if row[first] and row[first] in image.name]
        if not fits:
            sys.exit(f'{kind}: no row fits {image.name}')
        return max(fits, key=lambda row: len(row[first]))[rest]
    return of


def gather(args, place):
    """Copies images and marks into `place`, under names that train-detector reads; returns counts."""
    folder, of = Path(args.folder), grouping(args.group)
    groups, counts, left = {}, [], []
    for image in sorted(p for p in folder.rglob('*') if p.suffix.lower() in IMAGES):
        marks = marks_of(image, folder, args.marks and Path(args.marks))
        if not marks:
            left.append(image.name)
            continue
        points = read_points(marks, args.origin)
        pixels = np.asarray(Image.open(image).convert('F') if Image.open(image).mode.startswith('I') else Image.open(image).convert('L'), float)
        if not ((points >= -1) & (points <= np.array(pixels.shape[::-1]))).all():
            sys.exit(f'{marks}: marks lie outside {image.name}: x and y exchanged, in µm, or another --origin?')
        group = groups.setdefault(of(image), len(groups))
        name = f'{place}/g{group:03d}_s_{len(counts):04d}'
        top = 255 if pixels.max() <= 255 else pixels.max()
        Image.fromarray((pixels * (255 / top)).round().astype(np.uint8)).save(name + '.png')
        np.savetxt(name + '_coords.csv', points, '%.4f', ',')
        counts.append(len(points))
    if left:
        print(f'no marks, left out: {", ".join(left[:5])}{" …" if len(left) > 5 else ""} ({len(left)})', file=sys.stderr)
    if len(groups) < 2:
        sys.exit(f'{folder}: expected marked images of at least 2 groups, found {len(counts)} of {len(groups)}: see --group')
    return counts, len(groups)


def card(args, counts, groups, scores, seconds):
    """Returns the card of the model in Markdown."""
    few = '\n**Few images: the score says little about other images.**\n' if len(counts) < FEW else ''
    return f"""# Model card: {Path(args.out).name}

| | |
|---|---|
| Modality | {args.modality} |
| Data | {len(counts)} images, {groups} groups (`{args.group}`), {sum(counts)} marks |
| Date | {datetime.date.today().isoformat()} |
| Cross-validated Dice | {scores['dice']} (mean over images, found by the program; every group left out once) |
| Training | {seconds / 60:.1f} min on the CPU, {args.seeds} cross-validation(s), at most {args.folds} folds |
| Command | `scripts/train {shlex.join(sys.argv[1:])}` |
{few}
A mark counts as found within 0.75 of the marks' median nearest-neighbour distance (Cunefare et al.
2017). Threshold, radius of suppression and calibration of the score were chosen on the same images
left out, which raises the score a little. On images of another instrument it is not known.

Use: `conemosaic run IMAGES --modality {args.modality} --model {args.out} --out RESULTS`
"""


def main():
    """Gathers the images, trains on them and writes the card."""
    parser = argparse.ArgumentParser(prog='scripts/train', description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('folder', metavar='FOLDER', help='folder of images and marks')
    parser.add_argument('--modality', required=True, choices=['confocal', 'split'], help='modality of the images')
    parser.add_argument('--out', required=True, help='file of the model (.safetensors)')
    parser.add_argument('--marks', help='folder of the marks, if not beside the images or in FOLDER/marks')
    parser.add_argument('--group', default='prefix:2', help='prefix:N (first N parts of the name between underscores) or MANIFEST.csv:COLUMN [default: prefix:2]')
    parser.add_argument('--origin', type=float, default=1, help='coordinate of the centre of the first pixel in the marks; files with x_px, y_px count from 0 [default: 1]')
    parser.add_argument('--epochs', type=int, help='rounds of training [default: as for the shipped model]')
    parser.add_argument('--seeds', type=int, default=1, help='number of cross-validations [default: 1]')
    parser.add_argument('--folds', type=int, default=3, help='most folds of groups [default: 3]')
    parser.add_argument('--jobs', type=int, default=os.cpu_count(), help='folds trained at the same time [default: number of cores]')
    args = parser.parse_args()
    out, started = Path(args.out), time.time()
    if out.suffix != '.safetensors':
        parser.error('--out: expected a name that ends in .safetensors')
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as place:
        counts, groups = gather(args, place)
        more = ['--epochs', str(args.epochs)] if args.epochs else []
        done = subprocess.run([sys.executable, str(Path(__file__).with_name('train-detector')), place, '--modality', args.modality,
                               '--out', str(out), '--origin', '0', '--seeds', str(args.seeds), '--folds', str(args.folds),
                               '--jobs', str(args.jobs), *more])
        if done.returncode:
            sys.exit(done.returncode)
    scores = json.loads(out.with_suffix('.json').read_text())
    out.with_suffix('.md').write_text(card(args, counts, groups, scores, time.time() - started))
    print(f'cross-validated Dice: {scores["dice"]} ({len(counts)} images, {groups} groups)\nmodel: {out}\ncard:  {out.with_suffix(".md")}')


if __name__ == '__main__':
    main()
