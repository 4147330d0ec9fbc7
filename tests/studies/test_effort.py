"""Work that would take too much memory or time is refused at once, with the estimate."""

from __future__ import annotations

import pytest
from study_tools import write_study

from rlv_landing import Landing, LandingError
from rlv_landing.effort import check_duration, check_memory, duration_text, free_memory, size_text
from rlv_landing.studies.study_effort import check_indices, check_landings

AXES = ("--x", "drop.horizontal_velocity=-4..4", "--y", "drop.tilt=-0.2..0.2")
FACTORS = """
[[factor]]
name = "drop.tilt"
low = -0.1
high = 0.1
[[factor]]
name = "ground.friction"
low = 0.2
high = 0.5
"""


@pytest.mark.parametrize(
    ("until", "every", "message"),
    [
        (1e9, 1e-3, r"until 1e\+09 s in samples of 0.001 s needs \S+ PB of memory at least, and"),
        (1.0, 1e-10, r"samples of 1e-10 s needs \S+ TB of memory at least, and \S+ [MG]B is free"),
        (1.0, 1e-320, "of memory at least"),
        (1e300, 1e299, r"until = 1e\+300 s must be finite, after .* and at most 1e\+09 s"),
        (1e9, 1e6, r"would take 46.3 days at least, more than 30 days"),
    ],
)
def test_a_landing_that_does_not_fit_is_refused_before_it_begins(until, every, message):
    landing = Landing()
    with pytest.raises(LandingError, match=message):
        landing.run(until, every)
    assert landing.time == 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("samples = 20", "samples = 1000000000000"), "would take 31.7 years on one core at least"),
        (("until = 0.1", "until = 3600.0"), "GB is free; land shorter"),
        (("every = 2e-3", "every = 1e-6"), ""),
    ],
)
def test_a_study_that_does_not_fit_is_refused_and_makes_no_folder(
    tmp_path, command, change, message
):
    study = write_study(tmp_path)
    study.write_text(study.read_text().replace(*change).replace("every = 2e-3", "every = 1e-6"))
    arguments = ("--dry-run",) if not message else ("--results", str(tmp_path / "r"))
    done = command("sweep", str(study), *arguments)
    assert done.code == (2 if message else 0), done.err
    assert message in done.err
    assert not (tmp_path / "r").exists()


def test_a_grid_whose_product_explodes_is_refused_with_its_time(tmp_path, command):
    study = tmp_path / "g.toml"
    factor = '[[factor]]\nname = "{}"\nlow = 0.1\nhigh = 0.2\ncount = 100000000\n'
    names = ("drop.tilt", "ground.friction", "ground.slope")
    study.write_text('[study]\nmethod = "grid"\n' + "".join(map(factor.format, names)))
    done = command("sweep", str(study), "--dry-run")
    assert done.code == 2
    assert "this grid has 1e+24 points, more than 100000000, which would take" in done.err
    assert "years on one core at least; take fewer levels" in done.err


@pytest.mark.parametrize("option", ["--evaluations", "--polish", "--count"])
def test_searches_of_months_are_refused_with_their_time(tmp_path, command, option):
    done = command(
        "identify", option, "1000000000", "--work", str(tmp_path / "i"), "--workers", "1"
    )
    assert done.code == 2
    assert "1000000000 evaluations by 1 processes would take 69.4 days at least" in done.err
    assert not (tmp_path / "i").exists()


def test_limits_name_what_is_needed_and_what_there_is():
    assert 2**26 < free_memory() < 2**60
    check_memory("this", 1e6, "take less")
    check_duration("this", 29 * 86400.0, "take less")
    with pytest.raises(LandingError, match=r"this needs 1e\+03 PB of memory at least, and .* free"):
        check_memory("this", 1e18, "take less")
    assert [size_text(s) for s in (12, 3.1e6, 4.66e14)] == ["12 B", "3.1 MB", "466 TB"]
    assert [duration_text(s) for s in (3.0, 600.0, 1e5, 1e6, 1e9)] == [
        "3 s",
        "10 min",
        "27.8 h",
        "11.6 days",
        "31.7 years",
    ]


def test_families_whose_product_explodes_are_refused_with_their_time(tmp_path, command):
    values = ",".join(str(k / 1000) for k in range(1, 1001))
    names = ("ground.friction", "external.force_x", "external.force_y", "drop.pitch_rate")
    families = [a for n in names for a in ("--family", f"{n}={values}")]
    done = command("envelope", *AXES, *families, "--work", str(tmp_path / "e"))
    assert done.code == 2
    assert "families of 1e+12 boundaries would take 285 years at least" in done.err
    assert not (tmp_path / "e").exists()


def test_whole_numbers_of_500_digits_are_refused_with_their_time(command):
    done = command("identify", "--count", "9" * 500)
    assert done.code == 2
    assert "has more than 18 digits; so many steps of 1 ms would take 10^489 years" in done.err


def test_landings_until_they_are_decided_are_refused_by_the_memory_that_they_may_need(
    tmp_path, command
):
    study = tmp_path / "s.toml"
    study.write_text(f'[study]\nmethod = "sobol"\nsamples = 1024\nevery = 1e-6\n{FACTORS}')
    for name in ("sweep", "sensitivity"):
        done = command(name, str(study), "--workers", "1024", "--results", str(tmp_path / "r"))
        assert done.code == 2
        assert "until 60 s at most, every = 1e-06 s, 1024 landings at once, may need" in done.err
        assert not (tmp_path / "r").exists()


def test_an_envelope_that_does_not_fit_is_refused_and_makes_no_folder(tmp_path, command):
    study = tmp_path / "e.toml"
    study.write_text("[envelope]\nevery = 1e-5\n")
    work = ("--work", str(tmp_path / "e"))
    done = command("envelope", str(study), *AXES, "--until", "3600", "--workers", "64", *work)
    assert done.code == 2
    assert "until 3600 s at most, every = 1e-05 s, 64 landings at once, may need" in done.err
    families = ",".join(str(k / 1e4) for k in range(1, 900))
    fine = ("--cells", "256", "--family", f"ground.friction={families}", "--workers", "1")
    done = command("envelope", str(study), *AXES, "--until", "1 s", *fine, *work)
    assert done.code == 2
    assert "59378051 landings, until 1 s at most" in done.err
    assert "would take 69.4 days at least, more than 30 days" in done.err
    assert not (tmp_path / "e").exists()


def test_landings_on_a_cluster_are_not_timed():
    check_landings(10**8, 1, 100.0, 1e-2, decided=False, timed=False)
    with pytest.raises(LandingError, match="would take"):
        check_landings(10**8, 1, 100.0, 1e-2, decided=False)


def test_indices_that_do_not_fit_are_refused_before_the_landings(tmp_path, command):
    study = tmp_path / "s.toml"
    study.write_text(f'[study]\nmethod = "sobol"\nsamples = {2**26}\n{FACTORS}')
    done = command("sensitivity", str(study))
    assert done.code == 2
    assert f"this study has {2**28} points, more than 100000000" in done.err
    with pytest.raises(
        LandingError, match=r"needs 230 TB of memory at least.*; take fewer samples"
    ):
        check_indices(10**10, 7, 80, 999)
    with pytest.raises(LandingError, match=r"10000000000 resamples of .* would take 81 days"):
        check_indices(1000, 2, 1, 10**10)


def test_a_search_whose_memory_does_not_fit_is_refused(tmp_path, command, monkeypatch):
    monkeypatch.setattr("rlv_landing.effort.free_memory", lambda: 200_000_000)
    work = ("--workers", "1", "--work", str(tmp_path / "i"))
    done = command("identify", "--population", "100000", *work)
    assert "--population 100000 needs 300 MB of memory at least" in done.err
    done = command("identify", "--evaluations", "9999999", *work)
    assert "--evaluations 9999999 may need 600 MB of memory, and 200 MB is free" in done.err
    assert not (tmp_path / "i").exists()
