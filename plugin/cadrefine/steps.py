"""The steps of the filter Adapt To CAD, while it is at work: every rank has this module.

The filter tells its observers of each step on all ranks. On the rank that runs the driver the observer does what is
wanted with the step's mesh; on the others it serves that one, as satellites do between updates, until it is done.
"""

from paraview import simple
from paraview.modules import vtkRemotingServerManager  # noqa: F401  (sessions have what is used here by it alone)
from paraview.modules.vtkRemotingCore import vtkProcessModule
from vtkmodules.vtkParallelCore import vtkMultiProcessController

from cadrefine import session

STEP_EVENT = 1001  # vtkAdaptToCAD::StepEvent

# Run on every rank.
OBSERVE = """
from cadrefine import steps
steps.observe({number})
"""
HAND_OVER = """
from cadrefine import steps
self.GetOutput().ShallowCopy(steps.mesh)
"""
mesh = None  # This rank's piece of the step's mesh, as long as it is told of.
end_step = None  # What the driver does with it, on the rank where it runs.


class Following:
    """Calls `work` after each step of `proxy`, an AdaptToCAD, with a source of the step's mesh. What `work` raises
    ends the adaptation after this step; raise_failure raises it, after the update."""

    def __init__(self, proxy, work):
        global end_step
        self.work = work
        self.failure = None
        end_step = self.end_step
        session.run_on_all_ranks(OBSERVE.format(number=proxy.SMProxy.GetGlobalID()))

    def end_step(self, algorithm):
        try:
            source = simple.ProgrammableSource(Script=HAND_OVER, OutputDataSetType=mesh.GetClassName())
            source.UpdatePipeline()
            self.work(source)
            simple.Delete(source)
        except BaseException as failure:  # It would be lost in VTK.
            self.failure = failure
            algorithm.SetAbortExecute(1)

    def raise_failure(self):
        if self.failure is not None:
            raise self.failure


def observe(number):
    """From now on this rank takes part in the steps of the filter whose proxy has this number."""
    process = vtkProcessModule.GetProcessModule()
    process.GetActiveSession().GetSIObject(number).GetVTKObject().AddObserver(STEP_EVENT, tell)


def tell(algorithm, _event):
    global mesh
    mesh = algorithm.GetOutputDataObject(0)
    controller = vtkMultiProcessController.GetGlobalController()
    if end_step is None:
        controller.ProcessRMIs()
    else:
        end_step(algorithm)
        if controller is not None and not vtkProcessModule.GetProcessModule().GetSymmetricMPIMode():
            controller.TriggerBreakRMIs()
    mesh = None
