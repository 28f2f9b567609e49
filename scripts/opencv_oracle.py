#!/usr/bin/env python3
"""Finds cones by a second implementation of the classical filters, written with OpenCV.

    scripts/opencv_oracle.py JOBS.csv OUT

tests/it/opencv_oracle.rs compares the program with it. JOBS.csv has the columns
name,path,modality,polarity,spacing (px). For each job, the folder OUT gets

- NAME.image, NAME.flat and NAME.response: the image, the flattened image and the response of the
  filter, as little-endian float32, row by row;
- NAME.maxima.csv (column,row,x,y,score) and NAME.detections.csv (x,y,score).

All filters compute in float32. The border is reflected (BORDER_REFLECT), and Gaussians are cut at
ceil(4 sigma). Needs numpy and OpenCV.
"""
import csv
import math
import sys
from pathlib import Path

import cv2
import numpy as np

BORDER = cv2.BORDER_REFLECT
# least response of a maximum; radius of suppression, in spacings
CRITERIA = {'confocal': (0.0, 0.55), 'split': (0.6, 0.5), 'histology': (0.65, 0.45)}
# slope and offset of the threshold as a function of the upper quartile of the maxima
RELATIVE = {'split': (0.75, -0.7)}


def read_grey(path):
    """Returns a grey image as float32, from 0 to 1."""
    pixels = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    if pixels is None or pixels.ndim != 2:
        sys.exit(f'{path}: expected a grey image')
    return pixels.astype(np.float32) / np.float32(np.iinfo(pixels.dtype).max)


def gaussian(plane, sigma):
    """Returns the plane blurred by a Gaussian."""
    kernel = cv2.getGaussianKernel(2 * math.ceil(4 * sigma) + 1, sigma, cv2.CV_32F)
    return cv2.sepFilter2D(plane, cv2.CV_32F, kernel, kernel, borderType=BORDER)


def over_local_contrast(plane, sigma):
    """Returns the plane divided by its local root mean square."""
    contrast = cv2.sqrt(cv2.max(gaussian(cv2.multiply(plane, plane), sigma), 0))
    return cv2.divide(plane, cv2.max(contrast, 1e-3 * float(contrast.max())))


def flatten(image):
    """Returns the image less its slow drift, divided by its local contrast."""
    sigma = max(image.shape) / 8
    return over_local_contrast(cv2.subtract(image, gaussian(image, sigma)), sigma)


def negative_laplacian(plane):
    """Returns the negative Laplacian, which is high at bright spots."""
    return -cv2.Laplacian(plane, cv2.CV_32F, ksize=1, borderType=BORDER)


def confocal(image, s):
    """Returns the response of the confocal filter; `s` is the spacing in px."""
    return negative_laplacian(gaussian(image, 0.13 * s))


def histology(image, s):
    """Returns the response of the histology filter; `s` is the spacing in px."""
    return over_local_contrast(negative_laplacian(gaussian(image, 0.22 * s)), 2 * s)


def split(image, s):
    """Returns the response of the split-detector filter; `s` is the spacing in px."""
    h, w = image.shape
    pad = math.floor(s + 0.5)
    height, width = (cv2.getOptimalDFTSize(n + 2 * pad) for n in (h, w))
    framed = cv2.copyMakeBorder(image, pad, height - h - pad, pad, width - w - pad, BORDER)
    fx, fy = np.fft.fftfreq(width)[None], np.fft.fftfreq(height)[:, None]
    f2 = (fx ** 2 + fy ** 2) * s ** 2
    band = np.exp(-2 * np.pi ** 2 * 0.14 ** 2 * f2) * (1 - np.exp(-2 * np.pi ** 2 * 0.25 ** 2 * f2))
    # multiplied by i: real and imaginary part change places, the new real part changes sign
    gain = (np.sign(fx) * np.sqrt(np.abs(fx * s)) * band).astype(np.float32)
    spectrum = cv2.dft(framed, flags=cv2.DFT_COMPLEX_OUTPUT)
    turned = cv2.merge([-gain * spectrum[..., 1], gain * spectrum[..., 0]])
    filtered = cv2.dft(turned, flags=cv2.DFT_INVERSE | cv2.DFT_SCALE | cv2.DFT_REAL_OUTPUT)
    return over_local_contrast(np.ascontiguousarray(filtered[pad:pad + h, pad:pad + w]), 0.8 * s)


FILTERS = {'confocal': confocal, 'split': split, 'histology': histology}


def parabola_top(before, middle, after):
    """Returns the top of the parabola through three values, from −0.5 to 0.5."""
    before, middle, after = (np.float64(v) for v in (before, middle, after))
    curvature = before - 2 * middle + after
    return np.clip((before - after) / (2 * curvature), -0.5, 0.5) if curvature < 0 else 0.0


def local_maxima(response, threshold):
    """Returns the pixels that are the highest of their 3 × 3 neighbourhood.

    Each has (column, row, x, y, score).
    """
    h, w = response.shape
    top = (response == cv2.dilate(response, np.ones((3, 3), np.uint8))) & (response > threshold)
    found = []
    for row, column in np.argwhere(top):
        x, y = float(column), float(row)
        if 0 < column < w - 1:
            x += parabola_top(*response[row, column - 1:column + 2])
        if 0 < row < h - 1:
            y += parabola_top(*response[row - 1:row + 2, column])
        found.append((column, row, x, y, response[row, column]))
    return found


def suppress(maxima, radius):
    """Returns the maxima that have no higher one, kept itself, within `radius` px."""
    kept = []
    for _, _, x, y, score in sorted(maxima, key=lambda m: (-m[4], m[3], m[2])):
        if not kept or np.min(np.hypot(*(np.array(kept)[:, :2] - (x, y)).T)) > radius:
            kept.append((x, y, score))
    return kept


def select(kept, modality):
    """Returns the maxima above the threshold that follows the image."""
    if modality not in RELATIVE or not kept:
        return kept
    slope, offset = RELATIVE[modality]
    upper_quartile = kept[len(kept) // 4][2].astype(np.float64)
    return [cone for cone in kept if cone[2] > slope * upper_quartile + offset]


def write_rows(path, header, rows):
    """Writes a CSV file; numbers keep all their digits."""
    with open(path, 'w', newline='') as file:
        writer = csv.writer(file)
        writer.writerow(header)
        writer.writerows([repr(v.item()) if isinstance(v, np.generic) else repr(v) for v in row] for row in rows)


def main(jobs, out):
    """Runs all jobs."""
    out = Path(out)
    with open(jobs, newline='', encoding='utf-8') as file:
        for job in csv.DictReader(file):
            s = float(job['spacing'])
            image = read_grey(job['path'])
            response = FILTERS[job['modality']](image, s)
            if job['polarity'] == 'negative':
                response = -response
            threshold, reach = CRITERIA[job['modality']]
            maxima = local_maxima(np.ascontiguousarray(response), threshold)
            for stage, plane in (('image', image), ('flat', flatten(image)), ('response', response)):
                plane.astype('<f4').tofile(out / f'{job["name"]}.{stage}')
            write_rows(out / f'{job["name"]}.maxima.csv', ('column', 'row', 'x', 'y', 'score'), maxima)
            cones = select(suppress(maxima, reach * s), job['modality'])
            write_rows(out / f'{job["name"]}.detections.csv', ('x', 'y', 'score'), cones)


if __name__ == '__main__':
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
