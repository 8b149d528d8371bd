#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Opens a run folder with VTK's own reader and prints what it finds as JSON, one object per group and frame.

Usage: /usr/bin/python3 vtk_check.py DIR
Status 3: the package python3-vtk9 is missing. Status 1: VTK reports an error.
"""
import json
import os
import sys
import xml.etree.ElementTree

try:
    from vtkmodules.vtkCommonCore import vtkCommand
    from vtkmodules.vtkIOHDF import vtkHDFReader
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError as error:
    sys.stderr.write(f"VTK for Python is missing, install python3-vtk9: {error}\n")
    sys.exit(3)


def read(path, reader):
    """The grid in a file; ends the program if VTK complains."""
    errors = []
    reader.AddObserver(vtkCommand.ErrorEvent, lambda *_: errors.append(path))
    reader.SetFileName(path)
    reader.Update()
    if errors or reader.GetErrorCode():
        sys.exit(f"VTK cannot read {path}")
    return reader.GetOutputDataObject(0)


def values(array):
    """A list of tuples; of numbers if the array has one component."""
    tuples = [array.GetTuple(i) for i in range(array.GetNumberOfTuples())]
    return [t[0] for t in tuples] if array.GetNumberOfComponents() == 1 else tuples


def arrays(data):
    return {data.GetArrayName(i): values(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


def cell_points(cell):
    return [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]


def describe(grid):
    points = grid.GetPoints()
    return {
        "points": values(points.GetData()) if points else [],
        "cell_types": sorted({grid.GetCellType(i) for i in range(grid.GetNumberOfCells())}),
        "cells": [cell_points(grid.GetCell(i)) for i in range(grid.GetNumberOfCells())],
        "point_data": arrays(grid.GetPointData()),
        "cell_data": arrays(grid.GetCellData()),
        "field_data": arrays(grid.GetFieldData()),
    }


def frames(folder, group):
    """The index is read as plain XML: ParaView's reader of .pvd is not part of VTK."""
    index = os.path.join(folder, group + ".pvd")
    if not os.path.exists(index):
        return
    for entry in xml.etree.ElementTree.parse(index).iter("DataSet"):
        yield float(entry.get("timestep")), os.path.join(folder, entry.get("file"))


def describe_group(group):
    return [
        {"time": time, **describe(read(path, vtkXMLUnstructuredGridReader()))}
        for time, path in frames(sys.argv[1], group)
    ]


result = {group: describe_group(group) for group in ("elements", "ghosts", "bonds")}
temporal = os.path.join(sys.argv[1], "elements.vtkhdf")
if os.path.exists(temporal):
    # The reader of VTK 9.1 takes the frames for parts of one grid.
    result["vtkhdf"] = describe(read(temporal, vtkHDFReader()))
json.dump(result, sys.stdout)
