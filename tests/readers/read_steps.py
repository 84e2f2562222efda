"""Reads every time step of a file as a user of VTK or ParaView does, and prints what it sees as JSON: stress and
displacement at a node, stress in the first cell, and forces that are not zero, where the file has them.

    python3 read_steps.py vtk FILE NODE          VTK's own readers: .vtkhdf, .vtu
    pvpython read_steps.py paraview FILE NODE    what ParaView opens: .hdf.series, .pvd, .vtkhdf
"""

import json
import sys

TENSOR_COMPONENTS = 6


def seen(data, time, node):
    stress = data.GetPointData().GetArray("stress")
    assert stress is None or stress.GetNumberOfComponents() == TENSOR_COMPONENTS
    body = data.GetCellData().GetArray("body")
    cells = data.GetCellData().GetArray("stress_integration_points")
    return {
        "time": time,
        "points": data.GetNumberOfPoints(),
        "cells": data.GetNumberOfCells(),
        "bodies": sorted({int(body.GetTuple1(i)) for i in range(body.GetNumberOfTuples())}),
        "stress": None if stress is None else list(stress.GetTuple(node)),
        "displacement": list(data.GetPointData().GetArray("displacement").GetTuple(node)),
        "forces": [loaded(data.GetPointData().GetArray(name)) for name in ("force_inner", "force_outer")],
        "first_cell": None if cells is None else [cells.GetComponent(0, i) for i in range(cells.GetNumberOfComponents())],
    }


def loaded(force):
    """Points with a force, and the force."""
    if force is None:
        return None
    rows = (force.GetTuple(i) for i in range(force.GetNumberOfTuples()))
    return [[i, *row] for i, row in enumerate(rows) if any(row)]


def with_vtk(path, node):
    import vtk

    reader = vtk.vtkXMLUnstructuredGridReader() if path.endswith(".vtu") else vtk.vtkHDFReader()
    reader.SetFileName(path)
    # Asked directly, the HDF reader of some versions returns its first step for all times.
    through = vtk.vtkPassThrough()
    through.SetInputConnection(reader.GetOutputPort())
    through.UpdateInformation()
    keys = reader.GetOutputInformation(0)
    times = keys.Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS()) or [None]
    for time in times:
        through.Update() if time is None else through.UpdateTimeStep(time)
        yield seen(through.GetOutput(), time, node)


def with_paraview(path, node):
    from paraview import servermanager
    from paraview.simple import OpenDataFile

    reader = OpenDataFile(path)
    for time in reader.TimestepValues:
        reader.UpdatePipeline(time)
        data = servermanager.Fetch(reader)
        yield seen(data, time, node)
    # The reader must go before the HDF5 library does.
    del reader


WAYS = {"vtk": with_vtk, "paraview": with_paraview}
print("seen", json.dumps(list(WAYS[sys.argv[1]](sys.argv[2], int(sys.argv[3])))))
