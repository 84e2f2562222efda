"""What the meshes of housings share: groups, tetrahedra of second order, the file. Needs the Python package gmsh."""

import sys
from pathlib import Path

import gmsh


def mesh(groups, size, round_curves):
    """Meshes the geometry with tetrahedra of `size` mm and `round_curves` elements round a circle.

    `groups` are (dimension, tags, name) of physical groups.
    """
    for dimension, tags, name in groups:
        group = gmsh.model.addPhysicalGroup(dimension, tags)
        gmsh.model.setPhysicalName(dimension, group, name)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.5 * size)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", round_curves)
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    gmsh.option.setNumber("Mesh.HighOrderOptimize", 1)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.model.mesh.generate(3)


def write(build, out):
    """Writes the mesh that `build` makes to the file `out` and says its size."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    build()
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    gmsh.write(out)
    nodes = len(gmsh.model.mesh.getNodes()[0])
    tets = len(gmsh.model.mesh.getElementsByType(11)[0])
    print(f"{out}: {tets} tetrahedra, {nodes} nodes")
    gmsh.finalize()


def main(build, script, defaults):
    """Writes the mesh of `script` from its arguments SIZE, OUT and what follows them; `defaults` are their numbers."""
    arguments = sys.argv[1:]
    out = arguments.pop(1) if len(arguments) > 1 else str(Path(script).with_suffix(".msh"))
    numbers = [float(text) for text in arguments]
    numbers += defaults[len(numbers):]
    write(lambda: build(*numbers), out)
