"""XML of the exported files: elements with numbers, and a comment that says what was linearised."""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree.ElementTree import Comment, Element, SubElement, indent, tostring

from .linear import RULES
from .mechanism import Mechanism

LEFT_OUT = (
    "Left out: the legs' fluid states, friction of a sticking footpad's spring, steps below single",
    "footpads, points of the body that meet the ground, and a transverse load at the joint: the",
    "hinge bears it as at the footpad. Struts have no mass.",
)


def child(parent: Element, tag: str, text: str | None = None, **attributes: object) -> Element:
    """A new child; numbers and arrays are written in full precision."""
    made = SubElement(parent, tag, {name: written(value) for name, value in attributes.items()})
    made.text = text
    return made


def written(value: object) -> str:
    """The text of a value: a text, a number, or numbers side by side."""
    if isinstance(value, str):
        return value
    if isinstance(value, Iterable):
        # no -0.0
        return " ".join(repr(float(x) + 0.0) for x in value)
    return repr(float(value) + 0.0) if isinstance(value, (int, float)) else str(value)


def document(root: Element, made: Mechanism, notes: Iterable[str] = ()) -> str:
    """The text of a file, with what was linearised, and each leg's numbers, as a comment."""
    legs = (
        f"leg {leg.number}: main strut {leg.main.stiffness:.6g} N/m, {leg.main.damping:.6g} N s/m, "
        f"preload {leg.main.preload:.6g} N; auxiliary strut {leg.auxiliary.stiffness:.6g} N/m, "
        f"{leg.auxiliary.damping:.6g} N s/m"
        for leg in made.legs
    )
    lines = (
        "The vehicle of rlv-landing, linearised, at the start of its landing. SI units; x forward,",
        "y left, z up; the body's origin is its CG.",
        *RULES,
        *LEFT_OUT,
        *notes,
        *legs,
    )
    root.insert(0, Comment("\n" + "\n".join(f"    {line}" for line in lines) + "\n  "))
    indent(root)
    return '<?xml version="1.0"?>\n' + tostring(root, encoding="unicode") + "\n"
