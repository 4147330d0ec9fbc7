"""Messages to the importer: categories, format characters, and standard error without a logger."""

from __future__ import annotations

from ctypes import byref, c_char_p

import pytest
from fmpy import fmi2
from fmpy.fmi1 import FMICallException


def test_errors_that_the_host_does_not_log_are_on_standard_error(instance, capfd):
    instance.slave.setDebugLogging(loggingOn=False, categories=[])
    with pytest.raises(FMICallException):
        instance.start(**{"ground.friction": -1.0})
    assert "RlvLanding (test): ground.friction = -1 is outside [0, 3]" in capfd.readouterr().err
    assert instance.log == []


def test_errors_of_a_host_without_callbacks_are_on_standard_error(instance, capfd):
    assert not instance.slave.dll.fmi2Instantiate(
        b"mute", fmi2.fmi2CoSimulation, b"wrong", b"file:///x", None, 0, 1
    )
    assert "RlvLanding (mute): fmi2Instantiate: fmuGUID = wrong" in capfd.readouterr().err


def test_only_the_categories_asked_for_are_logged(instance):
    def provoke() -> list[str]:
        instance.log.clear()
        instance.categories.clear()
        instance.step(5.0, 1e-3)
        instance.status("fmi2CancelStep")
        return list(instance.categories)

    instance.start()
    assert provoke() == ["logStatusDiscard", "logStatusError"]
    for chosen, seen in (
        (["logStatusDiscard"], ["logStatusDiscard"]),
        (["logStatusError"], ["logStatusError"]),
        (["logStatusWarning"], []),
        (["logAll"], ["logStatusDiscard", "logStatusError"]),
        ([], ["logStatusDiscard", "logStatusError"]),
    ):
        instance.slave.setDebugLogging(loggingOn=True, categories=chosen)
        assert provoke() == seen
    instance.slave.setDebugLogging(loggingOn=False, categories=[])
    assert provoke() == []


def test_a_percent_sign_in_a_message_does_not_reach_the_hosts_printf(instance):
    instance.status("fmi2SetDebugLogging", 1, 1, (c_char_p * 1)(b"100%n"))
    assert "100%%n is no log category" in instance.reason()


@pytest.mark.parametrize("text", [b"x" * 10_000, b"\xff" * 10_000, "ü".encode() * 10_000])
def test_a_message_is_utf8_and_has_its_end_whatever_text_the_host_gives(instance, text):
    """The log's `decode` would fail."""
    instance.status("fmi2SetDebugLogging", 1, 1, (c_char_p * 1)(text))
    assert instance.reason().endswith(" is no log category of this FMU")
    assert not instance.slave.dll.fmi2Instantiate(
        b"one", fmi2.fmi2CoSimulation, text, b"file:///x", byref(instance.callbacks), 0, 1
    )
    assert instance.reason().endswith("description and binary are of different builds")
