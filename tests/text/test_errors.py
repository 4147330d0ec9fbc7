"""What errors of libraries and of the system say becomes words of one line."""

import errno
import sys

import pytest

from rlv_landing.errors import LandingError, reason_of
from rlv_landing.studies.sweep.extras import arrow
from rlv_ros_bridge.commands.view import require_viewer
from rlv_ros_bridge.logs.libraries import require_log_readers
from rlv_ros_bridge.ros.setup import require_ros

BROKEN = '''\
raise ImportError("""its C extension does not load:
    undefined symbol
The compiled module\twas not found.""")
'''


@pytest.mark.parametrize(
    ("library", "require"),
    [
        ("rclpy", require_ros),
        ("mcap", require_log_readers),
        ("rerun", require_viewer),
        ("pyarrow", arrow),
    ],
)
def test_a_library_that_does_not_load_is_told_in_words(library, require, tmp_path, monkeypatch):
    (tmp_path / f"{library}.py").write_text(BROKEN)
    monkeypatch.syspath_prepend(tmp_path)
    for name in [n for n in sys.modules if n.split(".")[0] == library]:
        monkeypatch.delitem(sys.modules, name)
    with pytest.raises(LandingError) as refused:
        require()
    text = str(refused.value)
    assert (
        "(its C extension does not load: undefined symbol The compiled module was not found.)"
        in text
    )
    assert "\\" not in text
    assert "pip install" in text


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (ValueError("two\n  lines"), "two lines"),
        (OSError(errno.ENOENT, "No such file\nor directory", "name"), "No such file or directory"),
        (OSError("no number"), "no number"),
        (TimeoutError(), "TimeoutError"),
    ],
)
def test_the_reason_is_the_words_of_the_error_or_its_name(error, said):
    assert reason_of(error) == said
