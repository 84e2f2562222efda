"""Comparison of HDF5 files: all data sets and attributes."""

import h5py
import numpy as np

from .difference import Difference, compare_reals

# Who wrote a file, and when; seals and checksums of tables follow from the content, which is compared itself, and the
# identity of a run from its scene and meshes.
LEFT_OUT = {"commit", "program_version", "created", "written", "run", "tables"}
SEAL = "crc32"


def is_left_out(name):
    """Whether an attribute does not belong to the result."""
    return name in LEFT_OUT or name == SEAL or name.endswith("_" + SEAL)


def entries(file):
    """All groups and data sets by path, the root first."""
    found = {"/": file}
    file.visititems(lambda name, item: found.__setitem__("/" + name, item))
    return found


def attributes(item):
    """Attributes that are compared."""
    return {name: item.attrs[name] for name in item.attrs if not is_left_out(name)}


def compare_values(place, old, new):
    """Difference of two arrays of any type, or None."""
    old, new = np.asarray(old), np.asarray(new)
    if old.dtype.kind == "f" and new.dtype.kind == "f":
        return compare_reals(place, old, new)
    if old.shape != new.shape or old.dtype != new.dtype:
        return Difference(place, text=f"{old.dtype} {old.shape} became {new.dtype} {new.shape}")
    if np.array_equal(old, new):
        return None
    is_secondary = place.endswith("_iterations")
    if old.size == 1:
        text = f"{shortened(old.item())} became {shortened(new.item())}"
        return Difference(place, text=text, is_secondary=is_secondary)
    count = int(np.count_nonzero(old != new))
    return Difference(place, text=f"{count} of {old.size} entries differ", is_secondary=is_secondary)


def shortened(value):
    """The value as text, not too long."""
    text = repr(value)
    return text if len(text) <= 80 else text[:77] + "..."


def compare_items(place, old, new):
    """Yields differences of two groups or data sets, without what is in the groups."""
    if type(old) is not type(new):
        yield Difference(place, text="a group became a data set, or the other way round")
        return
    a, b = attributes(old), attributes(new)
    for name in sorted(a.keys() ^ b.keys()):
        yield Difference(f"{place} attribute {name}", text="in one version only")
    for name in sorted(a.keys() & b.keys()):
        yield compare_values(f"{place} attribute {name}", a[name], b[name])
    if isinstance(old, h5py.Dataset):
        if old.chunks != new.chunks or old.compression != new.compression:
            yield Difference(place, text="stored in other chunks or with another compression")
        if old.is_virtual and new.is_virtual:
            yield compare_sources(place, old, new)
        else:
            yield compare_values(place, old[()], new[()])


def compare_sources(place, old, new):
    """A virtual data set shows parts of step files, which are compared themselves."""
    def listed(data):
        return [(s.file_name, s.dset_name, data.shape) for s in data.virtual_sources()]

    return None if listed(old) == listed(new) else Difference(place, text="shows other parts of step files")


def compare_files(name, old_path, new_path):
    """All differences of two files."""
    with h5py.File(old_path, "r") as old_file, h5py.File(new_path, "r") as new_file:
        old, new = entries(old_file), entries(new_file)
        found = [Difference(f"{name} {p}", text="in the old version only") for p in old.keys() - new.keys()]
        found += [Difference(f"{name} {p}", text="in the new version only") for p in new.keys() - old.keys()]
        for path in sorted(old.keys() & new.keys()):
            found += compare_items(f"{name} {path}", old[path], new[path])
    return [difference for difference in found if difference]
