"""Pictures for the scripts beside this one."""
import array


def read_pfm(path):
    """All values of a PFM file, rows as they stand there, clamped to [0, 1]."""
    with open(path, "rb") as f:
        f.readline(), f.readline(), f.readline()
        values = array.array("f")
        values.frombytes(f.read())
    return [min(max(v, 0), 1) for v in values]
