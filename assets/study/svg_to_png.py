#!/usr/bin/env python3
"""Paints the pictures of `weft study` as PNG: svg_to_png.py PICTURE.svg... writes PICTURE.png beside each.

Knows only what they are made of: rectangles, straight paths and words. Needs matplotlib."""
import re
import sys
import xml.etree.ElementTree as xml

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot  # noqa: E402
from matplotlib.patches import PathPatch  # noqa: E402
from matplotlib.path import Path  # noqa: E402

POINT = 72 / 96  # an SVG unit is 1/96 inch
ANCHORS = {"start": "left", "middle": "center", "end": "right"}


def corners(shape):
    """The shape's points and whether it is closed."""
    if shape.tag.endswith("rect"):
        x, y, w, h = (float(shape.get(key)) for key in ("x", "y", "width", "height"))
        return [(x, y), (x + w, y), (x + w, y + h), (x, y + h)], True
    numbers = [float(number) for number in re.findall(r"-?\d+\.?\d*", shape.get("d"))]
    return list(zip(numbers[::2], numbers[1::2])), shape.get("d").endswith("Z")


def add_shape(axes, shape, order):
    points, closed = corners(shape)
    codes = [Path.MOVETO] + [Path.LINETO] * (len(points) - 1)
    if closed:
        points, codes = points + points[:1], codes + [Path.CLOSEPOLY]
    width = float(shape.get("stroke-width")) * POINT
    dash = shape.get("stroke-dasharray")
    style = (0, [float(d) * POINT / width for d in dash.split()]) if dash else "solid"
    axes.add_patch(PathPatch(Path(points, codes), facecolor=shape.get("fill"), edgecolor=shape.get("stroke"),
                             linewidth=width, linestyle=style, alpha=float(shape.get("opacity", 1)),
                             joinstyle="round", capstyle="butt", zorder=order))


def add_words(axes, words, order):
    turn = re.match(r"rotate\((-?\d+)", words.get("transform", ""))
    axes.text(float(words.get("x")), float(words.get("y")), words.text, fontsize=float(words.get("font-size")) * POINT,
              color=words.get("fill"), ha=ANCHORS[words.get("text-anchor")], va="baseline",
              weight=words.get("font-weight", "normal"), rotation=-float(turn.group(1)) if turn else 0,
              rotation_mode="anchor", zorder=order, family="DejaVu Sans", parse_math=False)


def paint(name):
    picture = xml.parse(name).getroot()
    width, height = (float(picture.get(key)) for key in ("width", "height"))
    figure = plot.figure(figsize=(width / 96, height / 96))
    axes = figure.add_axes([0, 0, 1, 1])
    axes.set_axis_off()
    axes.set_xlim(0, width)
    axes.set_ylim(height, 0)
    for order, part in enumerate(picture):
        if part.tag.endswith("text"):
            add_words(axes, part, order)
        elif part.tag.endswith(("rect", "path")):
            add_shape(axes, part, order)
    figure.savefig(re.sub(r"\.svg$", "", name) + ".png", dpi=192)
    plot.close(figure)


for argument in sys.argv[1:]:
    paint(argument)
