"""Simulates an FMU for 0.1 s with the standard library alone, and prints the final height.

python3 fly_fmu.py FILE.fmu
"""

import ctypes
import sys
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree

Logger = ctypes.CFUNCTYPE(
    None, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p
)


class Callbacks(ctypes.Structure):
    """The importer's functions; quadcore only uses the logger."""

    _fields_ = (("logger", Logger), ("others", ctypes.c_void_p * 4))


@Logger
def say(_environment, _instance, _status, _category, message):
    """Print a message of the FMU."""
    print(message.decode(), file=sys.stderr)


with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    with zipfile.ZipFile(sys.argv[1]) as archive:
        archive.extractall(name)
    root = ElementTree.parse(str(folder / "modelDescription.xml")).getroot()
    library = root.find("CoSimulation").attrib["modelIdentifier"]
    height = next(v for v in root.iter("ScalarVariable") if v.get("name") == "z")
    fmu = ctypes.CDLL(str(folder / f"binaries/linux64/{library}.so"))
    fmu.fmi2Instantiate.restype = ctypes.c_void_p
    callbacks = Callbacks(logger=say)
    one = ctypes.c_void_p(
        fmu.fmi2Instantiate(
            b"one", 1, root.attrib["guid"].encode(), (folder / "resources").as_uri().encode(),
            ctypes.byref(callbacks), 0, 0,
        )
    )  # fmt: skip
    z = ctypes.c_double()
    begin, length = ctypes.c_double(0), ctypes.c_double(0.1)
    if not one or any(
        (
            fmu.fmi2EnterInitializationMode(one),
            fmu.fmi2ExitInitializationMode(one),
            fmu.fmi2DoStep(one, begin, length, 0),
            fmu.fmi2GetReal(
                one,
                ctypes.byref(ctypes.c_uint(int(height.attrib["valueReference"]))),
                ctypes.c_size_t(1),
                ctypes.byref(z),
            ),
        )
    ):
        sys.exit(f"{sys.argv[1]}: the simulation failed. See the messages above.")
    print(repr(z.value))
