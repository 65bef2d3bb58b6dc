"""FMUs as FMPy, an importer of others, flies them."""

from __future__ import annotations

from ctypes import byref, c_char_p
from pathlib import Path

import fmpy
from fmpy import fmi2


class Imported:
    """One instance of an FMU."""

    def __init__(self, path, folder, name="one", initialise=True, **parameters):
        folder.mkdir(parents=True, exist_ok=True)
        self.said = []
        fmpy.extract(str(path), str(folder))
        self.description = fmpy.read_model_description(str(folder))
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.folder = folder
        self.slave = fmi2.FMU2Slave(
            guid=self.description.guid,
            unzipDirectory=str(folder),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.callbacks = fmi2.fmi2CallbackFunctions()
        self.callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(self._log)
        self.slave.instantiate(callbacks=self.callbacks)
        self.time = 0.0
        self.slave.setupExperiment()
        for variable, value in parameters.items():
            self.set(variable, value)
        if initialise:
            self.initialise()

    def _log(self, _, instance, status, category, message):
        self.said.append((status, message.decode()))

    def initialise(self):
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def reference(self, name):
        return self.variables[name].valueReference

    def get(self, *names):
        return self.slave.getReal([self.reference(name) for name in names])

    def set(self, name, value):
        variable = self.variables[name]
        if variable.type == "Real":
            self.slave.setReal([variable.valueReference], [value])
        elif variable.type == "Integer":
            self.slave.setInteger([variable.valueReference], [value])
        elif variable.type == "Boolean":
            self.slave.setBoolean([variable.valueReference], [value])
        else:
            array = (c_char_p * 1)(str(value).encode())
            self.slave.fmi2SetString(
                self.slave.component,
                byref(fmi2.fmi2ValueReference(variable.valueReference)),
                1,
                array,
            )

    def command(self, speeds):
        references = [self.reference(f"w{i}") for i in range(1, 1 + len(speeds))]
        self.slave.setReal(references, list(speeds))

    def step(self, length=0.001):
        self.slave.doStep(self.time, length)
        self.time += length

    def topic(self, name):
        """As `Simulation.topic` has it."""
        fields = [v[len(name) + 1 :] for v in self.variables if v.startswith(f"{name}.")]
        return dict(zip(fields, self.get(*(f"{name}.{field}" for field in fields))))

    def row(self):
        """The log's row without its time."""
        state = ("x", "y", "z", "qx", "qy", "qz", "qw", "vx", "vy", "vz", "wx", "wy", "wz")
        return self.get(*state, "j1", "j2", "j3", "j4")

    def close(self):
        self.slave.freeInstance()


def library(folder):
    """The FMU's own library in the folder that it was taken apart in."""
    [found] = [p for p in Path(folder, "binaries/linux64").glob("*.so") if "quad" in p.name]
    return found
