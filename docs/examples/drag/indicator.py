"""The dual weighted residual of each cell: where the mesh is too coarse for the drag.

The error of a functional is the residual of the discrete flow, times what the dual solution has beyond its interpolant,
which is at most of the order of h |grad phi|: J. Hoffman, C. Johnson, Computational Turbulent Incompressible Flow,
Springer, 2007; J. Hoffman, Computation of mean drag for bluff body problems using adaptive DNS/LES, SIAM J. Sci. Comput.
27, 2005. S. Strunk's thesis, section 5.4, refines with the same kind of indicator.
"""

import dolfin as df

from flow import QUADRATURE, convection, mesh_size, velocity


def dual_weighted_residual(flow, dual):
    """The indicator, constant in each cell: a df.Function.

    flow: flow.Flow with its mean computed; dual: df.Function (phi, theta). It is the integral over the cell of

        h (|u.grad u + grad p| |grad phi| + |div u| |grad theta|)

    and over its inner facets of h / 2 |[nu du/dn]| |grad phi|, the jump that stands for nu laplace u. The part of the
    stabilisation, and all constants, are left out: it is for comparing cells, not a bound.
    """
    mesh, u, p = flow.mesh, velocity(flow.mean), flow.mean[3]
    space = df.FunctionSpace(mesh, "DG", 0)
    h, of_cell = mesh_size(mesh), df.TestFunction(space)
    momentum_weight = h * size(df.grad(velocity(dual)))
    momentum, continuity = size(convection(u, u) + df.grad(p)), abs(df.div(u))
    jump = 0.5 * flow.nu * size(df.jump(df.grad(u), df.FacetNormal(mesh)))
    form = (of_cell * (momentum * momentum_weight + continuity * h * size(df.grad(dual[3])))
            * df.dx(metadata=QUADRATURE)
            + jump * 2.0 * df.avg(of_cell * momentum_weight) * df.dS(metadata=QUADRATURE))
    return df.Function(space, df.assemble(form))


def size(a):
    return df.sqrt(df.inner(a, a))
