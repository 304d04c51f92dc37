"""Incompressible flow past a wing, and the dual problem for its drag, with linear elements in space and time.

The method is in the spirit of G2, cG(1)cG(1) with least squares stabilisation: J. Hoffman, C. Johnson, Computational
Turbulent Incompressible Flow, Springer, 2007. A time step of length k finds the velocity u and the pressure p with

    ((u - u0) / k + b.grad m, v) + (nu grad m, grad v) - (p, div v) + (div m, q)
        + (delta1 (b.grad m + grad p), b.grad v + grad q) + (delta2 div m, div v) = 0

for all v, q, where u0 is the velocity before, m = (u + u0) / 2 that in the middle of the step, and b that in the middle
of the step before: so a step is one linear system. This lag is of first order in time; in a steady flow there is none.
The four unknowns of a vertex are one function w = (u, p).
"""

import dolfin as df

WING, INFLOW, SIDES, WALLS = 1, 2, 3, 4  # Tags of facets; 0 is the outflow.
QUADRATURE = {"quadrature_degree": 2}


def velocity(w):
    return df.as_vector([w[0], w[1], w[2]])


def convection(b, u):
    return df.dot(df.grad(u), b)


def mesh_size(mesh):
    """Edge of the equilateral tetrahedron of the same volume, a form a cell."""
    return (6.0 * df.sqrt(2.0) * df.CellVolume(mesh)) ** (1.0 / 3.0)


def stabilisation(b, nu, mesh):
    """delta1 and delta2 for the velocity `b`. delta1 is h / (2 |b|) where convection prevails, h^2 / (12 nu) where
    viscosity does. The book's 1 / k^2 is left out, so that the steady state does not depend on the time step."""
    h = mesh_size(mesh)
    speed = df.sqrt(df.dot(b, b))
    return 1.0 / df.sqrt((2.0 * speed / h) ** 2 + (12.0 * nu / h**2) ** 2), 0.5 * h * speed


def steady_form(b, u, p, deltas, nu, test):
    """The form above without the time derivative."""
    v, q = velocity(test), test[3]
    return (df.dot(convection(b, u), v) + nu * df.inner(df.grad(u), df.grad(v)) - p * df.div(v) + df.div(u) * q
            + deltas[0] * df.dot(convection(b, u) + df.grad(p), convection(b, v) + df.grad(q))
            + deltas[1] * df.div(u) * df.div(v)) * df.dx(metadata=QUADRATURE)


class Flow:
    """Flow of speed 1 along x.

    mesh: df.Mesh of tetrahedra; tags: df.MeshFunction on its facets; nu: kinematic viscosity, a float.
    `state` is the flow now, `mean` the average of the last steps: df.Function with the components u, p.
    """

    def __init__(self, mesh, tags, nu):
        self.mesh, self.tags, self.nu = mesh, tags, df.Constant(nu)
        self.space = df.VectorFunctionSpace(mesh, "CG", 1, dim=4)
        self.state, self.mean = df.Function(self.space), df.Function(self.space)

    def conditions(self, inflow, wing):
        """Velocity (inflow, 0, 0) and (wing, 0, 0) there, none through sides and walls: a list of df.DirichletBC."""
        parts = [(INFLOW, 0, inflow), (INFLOW, 1, 0.0), (INFLOW, 2, 0.0), (SIDES, 2, 0.0), (WALLS, 1, 0.0),
                 (WING, 0, wing), (WING, 1, 0.0), (WING, 2, 0.0)]
        return [df.DirichletBC(self.space.sub(component), df.Constant(value), self.tags, tag)
                for tag, component, value in parts]

    def start_from_inflow(self):
        """The inflow's velocity everywhere but on the wing."""
        self.state.assign(df.Constant((1.0, 0.0, 0.0, 0.0)))
        for condition in self.conditions(1.0, 0.0):
            condition.apply(self.state.vector())

    def run(self, time_step, steps, averaged):
        """Takes so many time steps; `mean` becomes the mean of the last `averaged` of them. Returns how much the
        velocity still changes a unit of time: the root of the mean square over the box."""
        before, after = self.state.copy(deepcopy=True), self.state.copy(deepcopy=True)
        form = self.step_form(self.state, before, time_step)
        left, right = df.Form(df.lhs(form)), df.Form(df.rhs(form))
        matrix, vector = df.PETScMatrix(self.mesh.mpi_comm()), df.PETScVector(self.mesh.mpi_comm())
        conditions, solver = self.conditions(1.0, 0.0), krylov_solver()
        assembler = df.Assembler()  # Not df.assemble, which takes no compiled form on Debian 13.
        self.mean.vector().zero()
        for step in range(steps):
            assembler.assemble(matrix, left)
            assembler.assemble(vector, right)
            for condition in conditions:
                condition.apply(matrix, vector)
            solver.set_operator(matrix)
            solver.solve(after.vector(), vector)
            before.assign(self.state)
            self.state.assign(after)
            if step >= steps - averaged:
                self.mean.vector().axpy(0.5 / averaged, before.vector() + after.vector())
        self.mean.vector().apply("insert")
        difference = velocity(self.state) - velocity(before)
        change = df.assemble(df.dot(difference, difference) * df.dx)
        return (change / df.assemble(df.Constant(1.0) * df.dx(self.mesh))) ** 0.5 / time_step

    def step_form(self, old, older, time_step):
        """Of a time step from `old`, with `older` the step before it; linear in the trial function."""
        w, test = df.TrialFunction(self.space), df.TestFunction(self.space)
        b = 0.5 * (velocity(old) + velocity(older))
        middle = 0.5 * (velocity(w) + velocity(old))
        return (df.dot(velocity(w) - velocity(old), velocity(test)) / df.Constant(time_step)
                * df.dx(metadata=QUADRATURE)
                + steady_form(b, middle, w[3], stabilisation(b, self.nu, self.mesh), self.nu, test))

    def mean_form(self, test):
        """The steady form of the mean flow; the deltas are held when it is differentiated."""
        u = velocity(self.mean)
        held = velocity(self.mean.copy(deepcopy=True))
        return steady_form(u, u, self.mean[3], stabilisation(held, self.nu, self.mesh), self.nu, test)

    def drag(self):
        """Force of the mean flow on the wing along x: the form's residual for test functions that are 1 there. (It
        converges twice as fast as the integral of the stress, and the dual problem is exact for it.)"""
        direction = df.Function(self.space)
        for condition in self.conditions(0.0, 1.0):
            condition.apply(direction.vector())
        return -df.assemble(self.mean_form(df.TestFunction(self.space))).inner(direction.vector())

    def dual(self):
        """Solution of the adjoint problem, linearised around the mean flow: a df.Function with the components of
        velocity and pressure. The drag's direction is its boundary value on the wing."""
        form = df.adjoint(df.derivative(self.mean_form(df.TestFunction(self.space)), self.mean))
        matrix = df.assemble(form)
        result = df.Function(self.space)
        vector = result.vector().copy()
        for condition in self.conditions(0.0, 1.0):
            condition.apply(matrix, vector)
        solver = krylov_solver()
        solver.set_operator(matrix)
        solver.solve(result.vector(), vector)
        return result


def krylov_solver():
    """GMRES; on each rank an incomplete factorisation."""
    solver = df.PETScKrylovSolver("gmres", "bjacobi")
    solver.parameters["relative_tolerance"] = 1e-6
    solver.parameters["maximum_iterations"] = 2000
    solver.parameters["nonzero_initial_guess"] = True
    solver.parameters["error_on_nonconvergence"] = True
    df.PETScOptions.set("ksp_gmres_restart", 200)
    solver.set_from_options()
    return solver
