"""The groups of a mesh that is written: those of the input, and of the CAD's faces and edges those facets that have
none.

A group has a name, a number (tag) and a dimension. A cell's tag tells the first of its groups; an array of 0 and 1 that
has a group's name tells all its cells, where there are cells of several groups.
"""

import dataclasses
import re

import numpy as np

from cadrefine.formats.grid import PHYSICAL, tag_array

ENTITIES = {0: "Vertex", 1: "Edge", 2: "Face"}  # By dimension.
NAME = "A-Za-z0-9_.-"  # What most solvers take in names.
BOUNDARY = "boundary"  # The facets in no group, where a format wants each facet in one.


def grouped(mesh):
    """The mesh with the array PHYSICAL, a tag above 0 for each cell in a group, and a name for each group. Cells
    without a tag that are part of a CAD entity of their own dimension get a group of it."""
    dimensions = mesh.cell_dimensions()
    tags = tags_of(mesh)
    groups = dict(mesh.groups)
    add_names(groups, tags, dimensions)
    add_entities(mesh, groups, tags, dimensions)
    used = {(int(tag), int(dimension)) for dimension in np.unique(dimensions)
            for tag in np.unique(tags[dimensions == dimension])}
    listed = {name for name in groups if is_list(mesh.cell_data.get(name))}
    groups = {name: pair for name, pair in groups.items() if pair in used or name in listed}
    return dataclasses.replace(mesh, groups=groups, cell_data={**mesh.cell_data, PHYSICAL: tags})


def tags_of(mesh):
    """Those of the first of TAG_ARRAYS that there is; none below 0, which gmsh takes for a turned entity."""
    name = tag_array(mesh.cell_data)
    if name is None:
        return np.zeros(len(mesh.cell_dimensions()), dtype=np.int32)
    return np.maximum(mesh.cell_data[name], 0).astype(np.int32)


def add_names(groups, tags, dimensions):
    """Names for the tags that have none."""
    named = set(groups.values())
    for dimension in np.unique(dimensions):
        for tag in np.unique(tags[(dimensions == dimension) & (tags > 0)]):
            if (int(tag), int(dimension)) not in named:
                groups[unused(f"group {tag}", groups)] = (int(tag), int(dimension))


def add_entities(mesh, groups, tags, dimensions):
    """Groups of CAD entities for the cells that have no tag, with tags above all others."""
    if "CADEntity" not in mesh.cell_data or "CADDimension" not in mesh.cell_data:
        return
    entities = mesh.cell_data["CADEntity"]
    free = (tags == 0) & (entities >= 0) & (mesh.cell_data["CADDimension"] == dimensions)
    found = [(int(dimension), int(entity)) for dimension in np.unique(dimensions[free])
             for entity in np.unique(entities[free & (dimensions == dimension)])]
    names = [mesh.entity_names.get(pair, "") for pair in found]
    tag = max([int(tags.max(initial=0)), *(pair[0] for pair in groups.values())])
    for (dimension, entity), name in zip(found, names):
        plain = f"{ENTITIES[dimension]} {entity}"
        if name in groups or names.count(name) > 1:
            name = f"{name} {plain}".strip()
        tag += 1
        groups[unused(name or plain, groups)] = (tag, dimension)
        tags[free & (dimensions == dimension) & (entities == entity)] = tag


def unused(name, groups):
    """The name, or with a number behind it if it is taken."""
    number = 2
    wanted = name
    while wanted in groups:
        wanted, number = f"{name} {number}", number + 1
    return wanted


def is_list(array):
    """Whether an array of cells is one of 0 and 1."""
    return array is not None and array.dtype == np.int8 and array.ndim == 1


def members(mesh, name):
    """Which cells are in a group of a mesh with PHYSICAL."""
    tag, dimension = mesh.groups[name]
    inside = mesh.cell_data[PHYSICAL] == tag
    if is_list(mesh.cell_data.get(name)):
        inside |= mesh.cell_data[name] == 1
    return inside & (mesh.cell_dimensions() == dimension)


def group_names(mesh, dimension, allowed=None):
    """{tag: name} of the groups of that dimension. `allowed` is a pattern of what a format takes in names: anything
    else becomes _, and the names stay different."""
    names = {}
    for name, (tag, of_dimension) in mesh.groups.items():
        if of_dimension == dimension:
            plain = re.sub(f"[^{allowed}]", "_", name) if allowed else name
            names[tag] = unused(plain, names.values()).replace(" ", "_") if allowed else name
    return names


def sets_of_groups(mesh):
    """For each cell the number of a set of groups; and the tags of these, the cell's own first."""
    tags = mesh.cell_data[PHYSICAL]
    columns = [tags]
    for name, (tag, _) in mesh.groups.items():
        if is_list(mesh.cell_data.get(name)):
            columns.append(np.where(members(mesh, name) & (tags != tag), tag, 0))
    rows, numbers = np.unique(np.column_stack(columns), axis=0, return_inverse=True)
    return numbers.ravel(), [[int(tag) for tag in row if tag > 0] for row in rows]


def set_groups(mesh, members):
    """Gives a mesh that is read its tags: `members` has a row of cell and tag for each group that a cell is in."""
    if len(members) == 0:
        return
    dimensions = mesh.cell_dimensions()
    cells, first = np.unique(members[:, 0], return_index=True)
    mesh.cell_data[PHYSICAL] = np.zeros(len(dimensions), dtype=np.int32)
    mesh.cell_data[PHYSICAL][cells] = members[first, 1]
    others = np.delete(members, first, axis=0)
    told = np.isin(members[:, 0], others[:, 0])
    names = {pair: name for name, pair in mesh.groups.items()}
    for tag, dimension in {(int(tag), int(dimensions[cell])) for cell, tag in members[told]}:
        inside = members[(members[:, 1] == tag) & (dimensions[members[:, 0]] == dimension), 0]
        name = names.get((tag, dimension), f"group {tag} of dimension {dimension}")
        mesh.cell_data[name] = np.zeros(len(dimensions), dtype=np.int8)
        mesh.cell_data[name][inside] = 1
