#!/usr/bin/python3
"""Steps of one ring with dolfinx, PETSc and MUMPS: S is factored once, a step is a product and a solve.

    dolfinx_steps.py MESH.npz STEPS

MESH.npz holds nodes, hexahedra, fixed (nodes) and loaded (nodes); see measure-steps. Hexahedra with linear
functions, average acceleration with a step of DT, a force of FORCE on each loaded node towards the axis, suddenly. Prints
processor seconds of set-up and of each step, and the mean displacement of the loaded nodes at the end.
"""

import sys
import time

import numpy
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI
from petsc4py import PETSc

DT = 1e-5
FORCE = 100.0
YOUNG, POISSON, DENSITY = 207e9, 0.3, 7800.0


def forms(domain, space):
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    mu, la = YOUNG / (2 * (1 + POISSON)), YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    strain = ufl.sym(ufl.grad(u))
    stress = 2 * mu * strain + la * ufl.tr(strain) * ufl.Identity(3)
    # Sums of eight points integrate these exactly on a straight hexahedron.
    dx = ufl.dx(metadata={"quadrature_degree": 3})
    return ufl.inner(stress, ufl.sym(ufl.grad(v))) * dx, DENSITY * ufl.inner(u, v) * dx


def dofs_at(space, points):
    """First dof of the node at each point."""
    tree = {tuple(numpy.round(x, 10)): i for i, x in enumerate(space.tabulate_dof_coordinates())}
    return numpy.array([tree[tuple(numpy.round(x, 10))] for x in points])


def assemble(form, bcs, diagonal):
    matrix = fem.petsc.assemble_matrix(fem.form(form), bcs=bcs, diagonal=diagonal)
    matrix.assemble()
    return matrix


def main():
    data = numpy.load(sys.argv[1])
    nodes, corners = data["nodes"], data["hexahedra"]
    element = ufl.Mesh(ufl.VectorElement("Lagrange", "hexahedron", 1))
    domain = mesh.create_mesh(MPI.COMM_SELF, corners[:, [0, 1, 3, 2, 4, 5, 7, 6]].astype(numpy.int64), nodes, element)
    space = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
    fixed = dofs_at(space, nodes[data["fixed"]]).astype(numpy.int32)
    bcs = [fem.dirichletbc(numpy.zeros(3), fixed, space)]
    start = time.process_time()
    stiffness, mass = forms(domain, space)
    m = assemble(mass, bcs, 0.0)
    s = assemble(stiffness + 4 / DT**2 * mass, bcs, 1.0)
    s.setOption(PETSc.Mat.Option.SPD, True)
    solver = PETSc.KSP().create(MPI.COMM_SELF)
    solver.setOperators(s)
    solver.setType("preonly")
    solver.getPC().setType("cholesky")
    solver.getPC().setFactorSolverType("mumps")
    solver.setUp()
    print("setup_cpu %.4f" % (time.process_time() - start))
    loaded = dofs_at(space, nodes[data["loaded"]])
    load, r, u = m.createVecLeft(), m.createVecLeft(), m.createVecLeft()
    for node, x in zip(loaded, nodes[data["loaded"]]):
        load.setValues([3 * node, 3 * node + 1], -FORCE * x[:2] / numpy.hypot(*x[:2]))
    load.assemble()
    v, a, history, new = u.duplicate(), u.duplicate(), u.duplicate(), u.duplicate()
    for _ in range(int(sys.argv[2])):
        start = time.process_time()
        history.zeroEntries()
        history.maxpy([4 / DT**2, 4 / DT, 1.0], [u, v, a])
        m.mult(history, r)
        r.axpy(1.0, load)
        solver.solve(r, new)
        # a' = 4/dt^2 (u' - u) - 4/dt v - a, v' = v + dt/2 (a + a').
        v.axpy(DT / 2, a)
        old = a.copy()
        a.zeroEntries()
        a.maxpy([4 / DT**2, -4 / DT**2, -4 / DT, -1.0], [new, u, v, old])
        a.axpy(2.0, old)
        v.axpy(DT / 2, a)
        new.copy(u)
        print("step_cpu %.4f" % (time.process_time() - start))
    x = u.getArray().reshape(-1, 3)[loaded]
    print("dofs %d" % (3 * len(nodes)))
    print("displacement %.6e" % numpy.linalg.norm(x, axis=1).mean())


main()
