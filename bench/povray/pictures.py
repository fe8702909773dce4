"""Pictures as lists of linear light in [0, 1], three numbers a pixel, rows from the top: reading what POV-Ray and vts write, and
measuring how far two of them are apart. Nothing but Python's own library, since the pictures are small."""
import array
import math
import re
import struct
import sys
import zlib


class Picture:
    def __init__(self, width, height, values):
        self.width, self.height, self.values = width, height, values


def clamp(value):
    """What is not a number is black, as `vts compare` has it."""
    return min(max(value, 0.0), 1.0) if value == value else 0.0


def encode(value):
    """Linear light to sRGB's curve."""
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055


def decode(code):
    return code / 12.92 if code <= 0.04045 else ((code + 0.055) / 1.055) ** 2.4


def read_ppm(path):
    """PPM of the sRGB curve: POV-Ray's +FP16 with File_Gamma=srgb. (With another curve its old scenes, which know no gamma, would be
    taken for something else.)"""
    data = open(path, 'rb').read()
    head = re.match(rb'P6\s+(?:#[^\n]*\n\s*)*(\d+)\s+(?:#[^\n]*\n\s*)*(\d+)\s+(?:#[^\n]*\n\s*)*(\d+)\s', data)
    if not head:
        raise ValueError('%s is no binary PPM' % path)
    width, height, most = (int(x) for x in head.groups())
    values = array.array('H' if most > 255 else 'B', data[head.end():])
    if most > 255 and sys.byteorder == 'little':
        values.byteswap()
    return Picture(width, height, [decode(value / most) for value in values])


def read_pfm(path):
    data = open(path, 'rb').read()
    head = re.match(rb'PF\s+(\d+)\s+(\d+)\s+(-?[\d.]+)\s', data)
    if not head:
        raise ValueError('%s is no PFM of colours' % path)
    width, height = int(head.group(1)), int(head.group(2))
    values = array.array('f', data[head.end():])
    if (float(head.group(3)) < 0) != (sys.byteorder == 'little'):
        values.byteswap()
    rows = [values[3 * width * y:3 * width * (y + 1)] for y in range(height)]
    return Picture(width, height, [clamp(value) for row in reversed(rows) for value in row])


def write_png(path, width, height, codes):
    """Bytes R G B, rows from the top."""
    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    rows = b''.join(b'\0' + bytes(codes[3 * width * y:3 * width * (y + 1)]) for y in range(height))
    with open(path, 'wb') as out:
        out.write(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 2, 0, 0, 0)) +
                  chunk(b'IDAT', zlib.compress(rows, 9)) + chunk(b'IEND', b''))


def codes_of(picture):
    """The picture as bytes of sRGB."""
    return bytes(int(encode(value) * 255 + 0.5) for value in picture.values)


def save_png(path, picture):
    write_png(path, picture.width, picture.height, codes_of(picture))


def beside(path, rows, pad=2):
    """A sheet: each row of `rows` is a list of pictures, or None for what is missing."""
    widths = [max((r[i].width for r in rows if i < len(r) and r[i]), default=0) for i in range(max(len(r) for r in rows))]
    heights = [max((p.height for p in r if p), default=20) for r in rows]
    width, height = sum(w + pad for w in widths), sum(h + pad for h in heights)
    sheet = bytearray(b'\x60\x20\x60' * (width * height))
    top = 0
    for row, high in zip(rows, heights):
        left = 0
        for picture, wide in zip(row, widths):
            if picture:
                codes = codes_of(picture)
                for y in range(picture.height):
                    at = 3 * ((top + y) * width + left)
                    sheet[at:at + 3 * picture.width] = codes[3 * picture.width * y:3 * picture.width * (y + 1)]
            left += wide + pad
        top += high + pad
    write_png(path, width, height, sheet)


def encoded(picture):
    return Picture(picture.width, picture.height, [encode(value) for value in picture.values])


def blurred(picture):
    """The mean of each pixel and its eight neighbours; at the rim, of those that exist."""
    w, h, v = picture.width, picture.height, picture.values
    across = []
    for y in range(h):
        for x in range(w):
            a, b = max(x - 1, 0), min(x + 1, w - 1)
            for c in range(3):
                across.append(sum(v[3 * (y * w + i) + c] for i in range(a, b + 1)) / (b - a + 1))
    out = []
    for y in range(h):
        a, b = max(y - 1, 0), min(y + 1, h - 1)
        for i in range(3 * w):
            out.append(sum(across[3 * w * j + i] for j in range(a, b + 1)) / (b - a + 1))
    return Picture(w, h, out)


def edges(picture, step=0.1):
    """For each pixel whether it lies at an edge: a channel of it and of one of its eight neighbours differ by more than `step`."""
    w, h, v = picture.width, picture.height, picture.values
    marked = [False] * (w * h)
    for y in range(h):
        for x in range(w):
            at = y * w + x
            for dx, dy in ((1, 0), (0, 1), (1, 1), (-1, 1)):
                if 0 <= x + dx < w and y + dy < h:
                    other = at + dy * w + dx
                    if any(abs(v[3 * at + c] - v[3 * other + c]) > step for c in range(3)):
                        marked[at] = marked[other] = True
    return marked


def rmse(a, b, without=None):
    """Over pixels and channels; pixels marked in `without` left out. Infinite when the sizes differ."""
    if (a.width, a.height) != (b.width, b.height):
        return math.inf
    total, count = 0.0, 0
    for i in range(a.width * a.height):
        if without and without[i]:
            continue
        count += 3
        for k in range(3 * i, 3 * i + 3):
            total += (a.values[k] - b.values[k]) ** 2
    return math.sqrt(total / count) if count else 0.0
