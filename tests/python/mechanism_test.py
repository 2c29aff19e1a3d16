# SPDX-License-Identifier: MIT
"""Mechanisms, held against closed forms, and their patches."""

import json
import math
import xml.etree.ElementTree

import numpy as np
import pytest

import oblique as ob


@pytest.fixture
def slider_crank():
    m = ob.Mechanism(title="Slider-crank")
    m.frame(O=(0, 0), P=(1, 0))
    m.body("crank", "O", "A", length=1)
    m.body("rod", "A", "B", length=2)
    m.slide("guide", point="B", along=("O", "P"))
    m.drive("motor", turns="crank", about="O", speed=1)
    m.sketch(A=(1, 0), B=(3, 0))
    return m


@pytest.fixture(scope="module")
def four_bar():
    from conftest import ROOT
    return ob.Mechanism(ROOT / "diagrams/mechanisms/four-bar.toml")


def test_moves_as_its_closed_form(slider_crank):
    motion = slider_crank.solve()
    phi = motion["motor"]
    np.testing.assert_allclose(motion["B.x"], np.cos(phi) + np.sqrt(4 - np.sin(phi) ** 2), rtol=0, atol=1e-14)  # rounding
    assert motion.rows.shape == (361, len(motion.names)) and motion.units["B.vx"] == "m/s"
    assert motion.point("A").shape == (361, 2)
    assert set(motion.status) == {"ok"}
    assert slider_crank.solve(5, until=1).t[-1] == 1


def test_is_what_its_text_says(slider_crank, tmp_path):
    slider_crank.save(tmp_path / "m.toml")
    again = ob.Mechanism(tmp_path / "m.toml")
    assert again.points == ("O", "P", "A", "B") and again.bodies == ("crank", "rod")
    assert again.slides == ("guide",) and again.drives == ("motor",) and again.length_unit == "m"
    np.testing.assert_array_equal(again.solve(9).rows, slider_crank.solve(9).rows)


def test_a_read_one_is_changed(four_bar):
    m = ob.Mechanism(text=four_bar.text, file="longer.toml")
    m.sketch(C=(3, 3))
    assert m.solve(3)["C.x"][0] == pytest.approx(four_bar.solve(3)["C.x"][0], abs=1e-12)


def test_refuses_places_of_a_wrong_shape(slider_crank):
    for place in ((1,), (1, 2, 3), "12", (1, math.nan)):
        with pytest.raises(ob.RequestError):
            slider_crank.frame(Q=place)
    with pytest.raises(ob.MechanismError) as thrown:
        ob.Mechanism(title="Empty").solve()
    assert thrown.value.kind in ("file", "request", "mobility")


def test_ends_at_its_limits():
    rocker = ob.Mechanism("diagrams/mechanisms/double-rocker.toml")
    with pytest.warns(ob.RunWarning):
        motion = rocker.solve(91, at_limit="open")
    assert set(motion.status) == {"ok", "open"} and motion.events
    assert np.isnan(motion["B.x"][motion.status == "open"]).all()
    assert set(rocker.solve(91, at_limit="reverse").status) <= {"ok", "dead-centre"}


def test_holds_its_expectations(four_bar):
    assert four_bar.expectations() and all(one.met for one in four_bar.expectations())


def test_check_and_modes(four_bar, program):
    assert four_bar.check().finding is None and "crank-rocker" in four_bar.check().text
    modes = four_bar.modes(at="90 deg")
    dyad = modes[1]
    assert dyad.name == "BCM-CD" and dyad.complete and [mode.selected for mode in dyad.modes].count(True) == 1
    printed = json.loads(program("modes", "diagrams/mechanisms/four-bar.toml", "--at", "90 deg", "--json"))
    assert [list(mode.points["C"]) for mode in dyad.modes] == [mode["points"]["C"] for mode in printed["groups"][1]["modes"]]


def test_compares_as_the_program_does(four_bar, program):
    study = four_bar.compare(gains=[1e3, 1e4, 1e5])
    printed = json.loads(program("compare", "diagrams/mechanisms/four-bar.toml", "--gain", "1e3,1e4,1e5", "--json"))
    assert list(study.errors) == [run["max_error"] for run in printed["runs"]]
    assert study.order == printed["order"]
    # The method: an error falls with the gain.
    assert study.order == pytest.approx(-1, abs=2e-3)
    assert study.errors.shape == study.gains.shape == study.rms_errors.shape == (3,)
    assert study.drive.shape == (361,) and study.runs[0].error_along.shape == (361,)
    assert study.runs[0].error_along.max() == pytest.approx(study.errors[0], rel=1e-12)
    assert sum(study.runs[0].parts.values()) == pytest.approx(study.errors[0], rel=1e-6)
    assert "-1.000" in str(study) and "order -1.000" in repr(study) and "<svg" in study._repr_html_()
    frame = pytest.importorskip("pandas") and study.to_pandas()
    assert list(frame["gain"]) == [1e3, 1e4, 1e5]


def test_comparisons_are_drawn(four_bar):
    pytest.importorskip("matplotlib")
    study = four_bar.compare(gains=np.logspace(2, 4, 3))
    axes = study.plot()
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), study.errors)
    assert axes.get_ylabel() == "largest error [m]" and "order -1.0" in axes.get_legend().get_texts()[0].get_text()
    assert len(study.plot_along().lines) == 3


def test_compares_methods():
    study = ob.Mechanism("diagrams/mechanisms/slider-crank.toml").compare([1e3, 1e4], methods=["triangles", "gradient"])
    assert [method for method, _ in study.orders] == ["triangles", "gradient"] and len(study.runs) == 4


def test_draws_elements(four_bar):
    one, two = (four_bar.compare(1e6, monte_carlo=40, tolerance="0.1 %", seed=7, threads=threads).monte_carlo
                for threads in (1, 2))
    np.testing.assert_array_equal(one.errors, two.errors)
    assert one.errors.shape == (40,)
    # by its definition: the share of runs that do not exceed it
    assert np.mean(one.errors <= one.percentile(95)) == 0.95
    pytest.importorskip("matplotlib")
    assert ob.plots.histogram(one).get_xlabel() == "largest error [m]"


def test_patches(four_bar):
    patch = four_bar.patch(gain=1e4)
    assert isinstance(patch, ob.Diagram) and patch.judgement["good"] and patch.options["gain"] == 1e4
    run = patch.run()
    exact = four_bar.solve(run.rows.shape[0])
    error = np.hypot(run["C.x"] - exact["C.x"], run["C.y"] - exact["C.y"]).max()
    # a distance of one point is at most that of the worst
    assert 0 < error <= four_bar.compare(1e4).errors[0] * 1.001
    again = four_bar.run(gain=1e4)
    np.testing.assert_array_equal(again.rows, run.rows)


def test_patches_for_a_machine(four_bar):
    patch = four_bar.patch(machine="tr-10")
    assert patch.machine == "tr-10" and patch.components and patch.components_text and patch.fits in (True, False)
    assert [sheet.title for sheet in patch.sheets] == ["patch list", "potentiometers", "static test", "function generators"]
    assert patch.sheets[1].rows and not patch.sheets[3].rows and "<table>" in patch.sheets[1]._repr_html_()
    study = four_bar.compare(machine="tr-10")
    assert study.machine["max_error"] > study.errors[0]


def test_fits():
    m = ob.Mechanism("diagrams/mechanisms/four-bar.toml")
    motion = m.solve(37)
    targets = {"M.x": motion["M.x"][:-1], "M.y": motion["M.y"][:-1], "crank": motion["crank"][:-1]}
    other = ob.Mechanism(text=m.text.replace('["C", "D"], length = 3 ', '["C", "D"], length = 3.1 '), file="other.toml")
    fit = other.fit(targets, "CD=2.5..3.5", starts=2)
    # the path is that of a mechanism of the family, so nothing but rounding to 10 digits is left
    assert fit.rms_before > 1e-3 > 1e-8 > fit.rms and fit.improved and fit.mechanisms_tried > 0
    (dimension,) = fit.dimensions
    assert dimension.name == "CD" and dimension.before == 3.1 and abs(dimension.after - 3) < 1e-8
    np.testing.assert_allclose(fit.mechanism.solve(37)["M.x"], motion["M.x"], atol=1e-8)


def test_pictures(four_bar):
    for picture in (four_bar.draw(), four_bar.draw(at="45 deg", positions=4, trace="M"),
                    four_bar.draw(magnify=500, gain=1e4), four_bar.plots("M")):
        xml.etree.ElementTree.fromstring(picture.svg)
    assert four_bar._repr_svg_() == four_bar.draw().svg
    assert ob.Mechanism(title="Empty")._repr_svg_() is None


def test_animations_and_reports(four_bar, tmp_path):
    moving = four_bar.animate(frames=24, duration="2 s", size=300)
    xml.etree.ElementTree.fromstring(moving.svg)
    for name in ("leg.svg", "leg.html"):
        moving.save(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 1000
    assert moving._repr_html_().startswith("<iframe") and moving._repr_svg_() is None
    page = four_bar.report(gain=1e4)
    page.save(tmp_path / "report.html")
    assert "Four-bar" in page.html and page._repr_html_().startswith("<iframe")


def test_machines_and_blocks(program):
    assert len(ob.machines) >= 2 and all(machine.title for machine in ob.machines.values())
    assert ob.blocks["multiplier"].inputs[0].name == "x" and len(ob.blocks) > 50
    assert str(ob.blocks["multiplier"]) == program("blocks", "multiplier")
    assert str(ob.machines["tr-10"]) == program("machines", "tr-10")
    assert "<table>" in ob.blocks._repr_html_() and "<table>" in ob.machines._repr_html_()


def test_budget_has_shares():
    study = ob.Mechanism("diagrams/mechanisms/four-bar.toml").compare(budget=True, tolerance=0.001, positions=37)
    budget = study.budget
    assert sum(one["share"] for one in budget["elements"]) == pytest.approx(1)
    assert budget["elements"][0]["error"] <= budget["error"] and budget["point"] == "C"
    assert "Error budget" in study.text
    with pytest.raises(ob.ReadError, match="nothing says how far"):
        ob.Mechanism("diagrams/mechanisms/four-bar.toml").compare(budget=True)


def test_the_yield_is_that_of_the_program(program):
    four_bar = ob.Mechanism("diagrams/mechanisms/four-bar.toml")
    options = {"monte_carlo": 300, "tolerance": "0.5%", "until_within": "5%"}
    drawn = four_bar.compare(1e6, good_below="1%", **options).monte_carlo
    printed = program("compare", four_bar.file, "--gain", "1e6", "--monte-carlo", "300", "--tolerance", "0.5%",
                      "--yield", "1%", "--until-within", "5%", "--json")
    assert drawn.yield_._asdict() == json.loads(printed)["monte_carlo"]["yield"]
    assert drawn.yield_.machines < 300
    assert drawn.yield_.good == np.count_nonzero(drawn.errors < drawn.yield_.below)
    assert f"{100 * drawn.yield_.part:.3g} % below" in repr(drawn)
    # a length
    assert four_bar.compare(1e6, good_below=drawn.yield_.below, **options).monte_carlo.yield_ == drawn.yield_
    assert four_bar.compare(1e6, monte_carlo=20, tolerance="0.5%").monte_carlo.yield_ is None
    for wrong in ({"good_below": 0}, {"good_below": "1 s"}, {"good_below": "1%", "until_within": 1}, {"until_within": 0.1},
                  {"good_below": "1%", "monte_carlo": 0}):
        with pytest.raises(ob.Error):
            four_bar.compare(1e6, **{"monte_carlo": 20, "tolerance": "0.5%", **wrong})


def test_refuses_more_rows_than_fit():
    four_bar = ob.Mechanism("diagrams/mechanisms/four-bar.toml")
    for work in (lambda: four_bar.solve(10**9), lambda: four_bar.compare(positions=10**9)):
        with pytest.raises(ob.RequestError, match="from 2 to 10000000"):
            work()
