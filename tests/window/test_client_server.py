"""The ParaView window connected to a server of two ranks: the plugin is loaded on both sides, on the server by its
configuration file; files are opened and filters applied. The same in pvpython, connected to a server of one rank:
the texts of the progress come to the client.

usage: test_client_server.py PLUGIN DATA OUTPUT
"""

import contextlib
import os
import socket
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "pvbatch"))
import driver
from test_session import read_json
from test_window import APPLY, choose_from_menu, open_file, panel
from window import Display, Window, python

TIMEOUT = 150
RANKS = 2

# Runs in the window and in pvpython.
HELPERS = """
import json
from paraview import servermanager, simple

def adapted_values(source):
    source.UpdatePipeline()
    fields = ("GlobalGeometricError", "GlobalCells", "ProjectedPoints", "InvalidCells")
    return {name: source.FieldData[name].GetRange(0)[0] for name in fields}

def largest_rank(source):
    is_new = hasattr(simple, "ProcessIds")  # Since ParaView 5.12; the older one is deprecated with a warning there.
    ranks = (simple.ProcessIds if is_new else simple.ProcessIdScalars)(Input=source)
    ranks.UpdatePipeline()
    return ranks.PointData["PointProcessIds" if is_new else "ProcessId"].GetRange(0)[1]
"""

CLIENT = """
import os, sys
from paraview import servermanager, simple
plugin, data, helpers, result, port = sys.argv[1:]
simple.Connect("localhost", int(port))
texts = []
handler = servermanager.ActiveConnection.Session.GetProgressHandler()
handler.AddObserver("ProgressEvent", lambda *_: texts.append(handler.GetLastProgressText()))
simple.LoadPlugin(plugin, remote=False, ns=globals())  # the server has it
exec(open(helpers).read())
cad = simple.OpenDataFile(os.path.join(data, "cylinder.brep"))
mesh = simple.OpenDataFile(os.path.join(data, "cylinder_coarse.vtu"))
adapted = AdaptToCAD(Input=mesh, CAD=cad)
values = {"adapted": adapted_values(adapted), "ranks": largest_rank(adapted) + 1}
adapted.ErrorMarking, adapted.MaximumSteps = "Threshold", 9  # for seconds: a server sends a text a second at most
adapted.UpdatePipeline()
json.dump({**values, "texts": texts}, open(result, "w"))
"""


def free_port():
    with contextlib.closing(socket.socket()) as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def configuration_of(plugin):
    """The file beside the plugin that names it, and says that it is loaded at once."""
    return os.path.join(os.path.dirname(plugin), "cadrefine.xml")


class Server:
    """pvserver under mpirun, on an X display of its own."""

    def __init__(self, window, ranks):
        self.port = free_port()
        folder = window.path(f"server{ranks}")
        os.makedirs(folder, mode=0o700)
        self.display = Display(folder)
        self.log = open(os.path.join(folder, "log.txt"), "w", encoding="utf-8")
        environment = {**window.environment(self.display), "PV_PLUGIN_CONFIG_FILE": configuration_of(window.plugin),
                       **driver.ENVIRONMENT}
        self.process = subprocess.Popen(["mpirun", "-np", str(ranks), "pvserver", f"--server-port={self.port}"],
                                        env=environment, stdout=self.log, stderr=subprocess.STDOUT)

    def __enter__(self):
        """As soon as it waits for its client, who would complain of another try otherwise."""
        while self.process.poll() is None:
            with open(self.log.name, encoding="utf-8") as log:
                if "Accepting connection" in log.read():
                    break
            time.sleep(0.1)
        return self

    def __exit__(self, *_):
        """A server ends when its client has left."""
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.terminate()
            self.process.wait()
        self.log.close()
        with self.display:
            assert self.process.returncode == 0, f"the server ended with {self.process.returncode}; see {self.log.name}"


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def values_of_client(window, data):
    """The values that pvpython gets, connected to a server of one rank."""
    result = window.path("client.json")
    with Server(window, 1) as server, Display(window.path("display")) as display:
        subprocess.run(["pvpython", write(window.path("client.py"), CLIENT), window.plugin, data,
                        window.path("helpers.py"), result, str(server.port)],
                       env=window.environment(display), check=True, timeout=100)
    return read_json(result)


def play(window, data, result):
    window.play(python(f"exec(open({window.path('helpers.py')!r}).read(), globals())"),
                *open_file(os.path.join(data, "cylinder.brep")), APPLY,
                *open_file(os.path.join(data, "cylinder_coarse.vtu")), APPLY)
    window.picture("opened")
    window.play(*choose_from_menu("AdaptToCAD"),
                *panel(("MaximumSteps", "visible", "true"), ("MaximumCells", "visible", "false"),
                       ("IndicatorThreshold", "visible", "false"), ("CADRegion", "visible", "false")), APPLY)
    window.picture("adapted")
    window.play(python("adapted = simple.FindSource('AdaptToCAD1')"),
                python("values = {'adapted': adapted_values(adapted), 'ranks': largest_rank(adapted) + 1}"),
                python(f"json.dump(values, open({result!r}, 'w'))"))


def main():
    plugin, data, output = map(os.path.abspath, sys.argv[1:])
    window = Window(plugin, output)
    write(window.path("helpers.py"), HELPERS)
    result = window.path("output", "values.json")
    play(window, data, result)
    with Server(window, RANKS) as server:
        window.run_well(TIMEOUT, "--server-url", f"cs://localhost:{server.port}")
    values = read_json(result)
    assert values["ranks"] == RANKS, values
    alone = values_of_client(window, data)
    assert alone["ranks"] == 1, alone
    assert values["adapted"] == alone["adapted"], (values, alone)
    assert any(text.startswith(("Projection", "Step ")) for text in alone["texts"]), alone["texts"]
    print(f"the same on {RANKS} ranks as on one: {values['adapted']}; pictures are in {output}")


if __name__ == "__main__":
    main()
