# SPDX-License-Identifier: MIT
"""Diagrams that are built in Python, and what else is asked of a diagram."""

import math
import tomllib
import xml.etree.ElementTree

import numpy as np
import pytest

import oblique as ob


def blocks_of(diagram):
    return tomllib.loads(diagram.toml())["blocks"]


def value_of(build, *inputs):
    """What a built signal is for constant inputs."""
    d = ob.Diagram(until=1, samples=2)
    d.output("y", build(*(d.constant(value=value) for value in inputs)))
    return d.run()["y"][-1]


def test_sums_are_wires_and_no_blocks():
    d = ob.Diagram()
    x, y = d.integrator(name="x", initial=1), d.integrator(name="y")
    x.input = y
    y.input = -0.5 * x - y / 4 + x - x
    assert blocks_of(d) == {"x": {"type": "integrator", "initial": 1, "in": ["y"]},
                            "y": {"type": "integrator", "in": ["-0.5*x", "-0.25*y"]}}


def test_gives_the_motion_of_an_oscillator():
    d = ob.Diagram(title="Oscillator", until=6)
    x = d.integrator(name="x", initial=1)
    v = d.integrator(-4 * x, name="v")
    x.input = v
    run = d.run()
    np.testing.assert_allclose(run["x"], np.cos(2 * run["t"]), rtol=0, atol=1e-7)  # the tolerance of 1e-8, tenfold


@pytest.mark.parametrize("build, inputs, value", [
    (lambda a, b: a + 2 * b, (0.25, 0.125), 0.5),
    (lambda a, b: a - b, (0.25, 0.125), 0.125),
    (lambda a: -a, (0.25,), -0.25),
    (lambda a: +a + 0.5, (0.25,), 0.75),
    (lambda a: 1 - a, (0.25,), 0.75),
    (lambda a, b: a * b, (0.25, 0.5), 0.125),
    (lambda a, b: (2 * a) * (-b), (0.25, 0.5), -0.25),
    (lambda a, b: (a + b) * (a - b), (0.5, 0.25), 0.1875),
    (lambda a: a * a, (0.5,), 0.25),
    (lambda a: a**3, (0.5,), 0.125),
    (lambda a: a**4, (0.5,), 0.0625),
    (lambda a: a**0.5, (0.25,), 0.5),
    (lambda a: a / 4, (0.5,), 0.125),
    (lambda a: np.float64(2) * a, (0.25,), 0.5),
    (lambda a: np.multiply(a, 2), (0.25,), 0.5),
    (lambda a: np.negative(a), (0.25,), -0.25),
    (lambda a: abs(a), (-0.25,), 0.25),
    (lambda a: np.sin(a), (0.5,), math.sin(0.5)),
    (lambda a: np.cos(a), (0.5,), math.cos(0.5)),
    (lambda a: np.exp(-a), (0.5,), math.exp(-0.5)),
    (lambda a: np.square(a), (0.5,), 0.25),
    (lambda a: np.arctan(a), (0.5,), math.atan(0.5)),
    (lambda a, b: np.maximum(a, b), (0.25, 0.5), 0.5),
    (lambda a, b: np.minimum(a, b), (0.25, 0.5), 0.25),
    (lambda a: np.minimum(a, 0.125), (0.25,), 0.125),
    (lambda a: np.sin(2 * a + 0.25), (0.125,), math.sin(0.5)),
    (lambda a: a > 0.125, (0.25,), 1),
    (lambda a: a < 0.125, (0.25,), 0),
])
def test_operators_are_those_of_numbers(build, inputs, value):
    # algebra alone; blocks of exponentials and others are exact to rounding, servo blocks to a gain of 1e6 or more
    assert value_of(build, *inputs) == pytest.approx(value, abs=1e-6)


@pytest.mark.parametrize("build, inputs, value", [
    (lambda a, b: a / b, (0.25, 0.5), 0.5),
    (lambda a: 0.25 / a, (0.5,), 0.5),
    (lambda a: np.sqrt(a), (0.25,), 0.5),
    (lambda a: np.log(a), (0.5,), math.log(0.5)),
    (lambda a, b: np.divide(a, b), (0.25, 0.5), 0.5),
])
def test_operators_that_servo_loops_make(build, inputs, value):
    # loops of gain 1e6 leave about 1e-6 of it over the divisor
    assert value_of(build, *inputs) == pytest.approx(value, abs=1e-5)


def test_inverting_machines_add_with_the_right_sign():
    d = ob.Diagram(inverting=True, until=1, samples=2)
    a, b = d.constant(value=0.25), d.constant(value=0.5)
    d.output("y", np.square(a + b))
    d.output("z", a + b)
    run = d.run()
    assert run["y"][-1] == pytest.approx(0.5625, abs=1e-12)
    assert run["z"][-1] == pytest.approx(0.75, abs=1e-12)


def test_wires_as_lucipy_does():
    d = ob.Diagram(until=2 * math.pi)
    x, v = d.integrator(initial=1, name="x"), d.integrator(name="v")
    d.connect(v, x)
    d.connect(x, v, weight=-1)
    run = d.run()
    np.testing.assert_allclose(run["x"], np.cos(run["t"]), rtol=0, atol=1e-7)
    d.connect("x", v, weight=-3)
    assert blocks_of(d)["v"]["in"] == ["-x", "-3.0*x"]


def test_blocks_of_several_inputs_and_outputs():
    d = ob.Diagram(until=1, samples=2)
    radius, angle = d.constant(value=0.5), d.constant(value=0.25)
    polar = d.resolver(radius, angle, name="polar")
    d.output("x", polar["x"])
    d.output("y", 2 * polar["y"], unit="V", scale=10, offset=1)
    run = d.run()
    assert run["x"][0] == pytest.approx(0.5 * math.cos(0.25), abs=1e-12)
    assert run["y"][0] == pytest.approx(10 * math.sin(0.25) + 1, abs=1e-12)
    assert run.units["y"] == "V"
    with pytest.raises(ob.UnknownNameError, match="'polar' has no output 'z'"):
        polar["z"]


def test_takes_points_of_a_function_as_an_array():
    x = np.linspace(-1, 1, 5)
    d = ob.Diagram(until=1, samples=2)
    (parameter,) = [one.name for one in ob.blocks["function-generator"].parameters if one.by_points]
    d.output("y", d.function_generator(d.constant(value=0.5), **{parameter: np.column_stack([x, x**2])}))
    assert d.run()["y"][0] == pytest.approx(0.25, abs=1e-12)  # a given point


def test_reads_and_goes_on_building():
    d = ob.Diagram("diagrams/lessons/circle.toml")
    x = d.signal("x")
    d.output("twice", 2 * x)
    run = d.run()
    np.testing.assert_array_equal(run["twice"], 2 * run["x"])
    assert d.signal("x") is x


def test_writes_what_it_reads(tmp_path):
    d = ob.Diagram(title='A "quoted" ütle', until="2*pi", machine="tr-10", tolerance=1e-9, method="adams", samples=11)
    x = d.integrator(initial=0.5, name="x", label="ẋ")
    x.input = x  # inverts there
    d.output("x")
    d.expect("x at 0", 0.5, within=1e-9)
    d.save(tmp_path / "d.toml")
    again = ob.Diagram(tmp_path / "d.toml")
    assert again.toml() == d.toml() and again.title == 'A "quoted" ütle' and again.machine == "tr-10"
    assert again.until == pytest.approx(2 * math.pi) and again.block_types == {"x": "integrator"}
    run = again.run(check=True)
    assert run.rows.shape == (11, 2) and run.expectations[0].met
    assert again.text == (tmp_path / "d.toml").read_text(encoding="utf-8")


def test_refuses_what_makes_no_sense():
    d = ob.Diagram()
    x = d.integrator(initial=1, name="x")
    other = ob.Diagram().integrator()
    for work, said in (
            (lambda: d.integrator(name="x"), "there is a block 'x' already"),
            (lambda: d.integrator(name="a b"), "no name of a block"),
            (lambda: d.integrator(inital=1), "'integrator' has no input or parameter 'inital'"),
            (lambda: d.integrator(initial=math.nan), "nan is not a number"),
            (lambda: d.integrator(initial=object()), "has no place in a file"),
            (lambda: d.multiplier(x, x, x), "3 signals for 'multiplier'"),
            (lambda: d.multiplier(x, x=x), "given twice"),
            (lambda: d.integrator(x, in_=x), "given twice"),
            (lambda: d.integrator(other), "of another diagram"),
            (lambda: x + other, "of another diagram"),
            (lambda: x * other, "two diagrams"),
            (lambda: x * math.nan, "nan is not a number"),
            (lambda: x + "y", "there is no block 'y'"),
            (lambda: x / 0, "divided by 0"),
            (lambda: x**2.5, "whole number"),
            (lambda: bool(x), "no truth value"),
            (lambda: float(x), "no number"),
            (lambda: np.tan(x), "no block is np.tan"),
            (lambda: np.add(x, np.ones(3)), "an array"),
            (lambda: x * [1, 2], "is no number"),
            (lambda: d.signal("z"), "there is no block 'z'"),
            (lambda: d.connect(x, other), "no block of this diagram"),
            (lambda: d.output("y"), "there is no block 'y'"),
            (lambda: (d.output("x"), d.output("x", 2 * x)), "there is an output 'x' already"),
            (lambda: d.sin(x), "no method and no block type 'sin'"),
            (lambda: d.set_input(x, x, "out"), "has no input 'out'")):
        with pytest.raises(ob.RequestError) as thrown:
            work()
        assert said in str(thrown.value), str(thrown.value)
    assert not hasattr(d, "sin") and not hasattr(d, "_repr_png_")
    with pytest.raises(ob.DiagramError):  # the wire that is missing
        d.run()


def test_methods_are_the_block_types():
    d = ob.Diagram()
    assert "servo_amplifier" in dir(d) and "open-loop gain" in d.servo_amplifier.__doc__
    # each type has a method of its own: no name is one of the class
    assert not [name for name in ob.blocks if hasattr(ob.Diagram, name.replace("-", "_"))]


def test_own_blocks():
    own = ob.BlockLibrary("diagrams/own-blocks/blocks")
    run = ob.Diagram("diagrams/own-blocks/triangle-wave.toml", blocks=own).run(check=True)
    assert all(one.met for one in run.expectations)
    d = ob.Diagram(blocks="diagrams/own-blocks/blocks", until=1)
    x = d.integrator(initial=1, name="x")
    x.input = -d.schmitt_trigger(x)
    assert d.run().event_count > 0


def test_check():
    found = ob.Diagram("diagrams/lessons/triangle-side.toml").check()
    assert found.verdict.startswith("stable") and "overloads" in found.text and found.failure == ()
    assert found.data and "<pre>" in found._repr_html_()
    xml.etree.ElementTree.fromstring(found.poles.svg)
    d = ob.Diagram(until=1)
    x = d.integrator(initial=0.1, name="x")
    x.input = x
    assert d.check().verdict == "grows"
    assert d.check(set={"x.rate": -1}).verdict.startswith("stable")


def test_static_test():
    readings = ob.Diagram("diagrams/lessons/circle.toml").static_test()
    assert readings["x"] == (1.0, pytest.approx(0, abs=1e-12))


def test_rescaled():
    d = ob.Diagram(until=6)
    x = d.integrator(name="x", initial=3)
    v = d.integrator(-x, name="v")
    x.input = v
    d.output("x", unit="m")
    scaled = d.rescaled()
    np.testing.assert_allclose(scaled.run()["x"], d.run()["x"], atol=1e-6)  # two runs of tolerance 1e-8 of 3
    assert d.run(watch_overloads=True).overloads and not scaled.run(watch_overloads=True).overloads


def test_is_drawn():
    d = ob.Diagram("diagrams/lessons/triangle-side.toml")
    assert d._repr_svg_() == d.draw().svg
    xml.etree.ElementTree.fromstring(d.draw(symbols="din", depth=1, theme="dark").svg)
    assert ob.Diagram()._repr_svg_() is None  # nothing yet


def test_text_of_several_lines_is_a_text():
    assert ob.Diagram('format = "oblique-diagram/1"\n[blocks]\nx = { type = "constant", value = 1 }\n').run()["x"][0] == 1
