"""The file modelDescription.xml of FMI 2.0."""

from __future__ import annotations

from typing import Sequence
from xml.etree import ElementTree

from .variables import Variable


def make_description(
    model: str, identifier: str, guid: str, tool: str, step: float, variables: Sequence[Variable]
) -> bytes:
    """Make the description of an FMU.

    Parameters
    ----------
    model
        Name of the vehicle.
    identifier
        Name of the library without its suffix.
    guid
        GUID that the library checks.
    tool
        Name of the program that writes the FMU.
    step
        Minimum step, s.
    variables
        All variables, in the order of their value references.
    """
    root = ElementTree.Element(
        "fmiModelDescription",
        fmiVersion="2.0",
        modelName=model,
        guid=guid,
        generationTool=tool,
        variableNamingConvention="flat",
    )
    ElementTree.SubElement(
        root,
        "CoSimulation",
        modelIdentifier=identifier,
        canHandleVariableCommunicationStepSize="true",
        canNotUseMemoryManagementFunctions="true",
        canGetAndSetFMUstate="true",
        canSerializeFMUstate="true",
    )
    units = sorted({variable.unit for variable in variables} - {""})
    if units:
        definitions = ElementTree.SubElement(root, "UnitDefinitions")
        for unit in units:
            ElementTree.SubElement(definitions, "Unit", name=unit)
    categories = ElementTree.SubElement(root, "LogCategories")
    for name in ("logStatusWarning", "logStatusError"):
        ElementTree.SubElement(categories, "Category", name=name)
    ElementTree.SubElement(root, "DefaultExperiment", startTime="0", stepSize=repr(step))
    listed = ElementTree.SubElement(root, "ModelVariables")
    for reference, variable in enumerate(variables):
        _add(listed, reference, variable)
    structure = ElementTree.SubElement(root, "ModelStructure")
    for kind in ("Outputs", "InitialUnknowns"):
        unknowns = ElementTree.SubElement(structure, kind)
        for place, variable in enumerate(variables, start=1):
            if variable.causality == "output":
                ElementTree.SubElement(unknowns, "Unknown", index=str(place))
    text: bytes = ElementTree.tostring(root, encoding="UTF-8")
    return text


def _add(listed: ElementTree.Element, reference: int, variable: Variable) -> None:
    element = ElementTree.SubElement(
        listed,
        "ScalarVariable",
        name=variable.name,
        valueReference=str(reference),
        causality=variable.causality,
        variability=variable.variability,
    )
    if variable.causality == "parameter":
        element.set("initial", "exact")
    if variable.causality == "output":
        element.set("initial", "calculated")
    if variable.description:
        element.set("description", variable.description)
    value = ElementTree.SubElement(element, variable.type)
    if variable.start is not None:
        value.set("start", variable.start)
    if variable.unit:
        value.set("unit", variable.unit)
