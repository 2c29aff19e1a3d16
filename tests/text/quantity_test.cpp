// SPDX-License-Identifier: MIT
#include <oblique/text/quantity.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace oblique::text {
namespace {

Unit unit(std::string_view text) {
  return parse_unit(text).value();
}

double quantity(std::string_view text, std::string_view wanted) {
  return parse_quantity(text, unit(wanted));
}

std::string quantity_message(std::string_view text, std::string_view wanted) {
  try {
    quantity(text, wanted);
  } catch (const ExpressionError& error) {
    std::string message = std::to_string(error.column) + ": " + error.what;
    if (!error.expected.empty()) message += "; expected " + error.expected;
    if (!error.remedy.empty()) message += "; " + error.remedy;
    return message;
  }
  return "no error";
}

TEST(Unit, KnowsItsSizeAndDimension) {
  EXPECT_DOUBLE_EQ(unit("mm").scale, 1e-3);
  EXPECT_EQ(unit("mm").exponents[Unit::length], 1);
  // 1 mm/s² = 10⁻³ m/s²; DOUBLE_EQ (4 units in the last place) covers the product of two rounded factors.
  EXPECT_DOUBLE_EQ(unit("mm/s^2").scale, 1e-3);
  EXPECT_EQ(unit("mm/s^2").exponents[Unit::length], 1);
  EXPECT_EQ(unit("mm/s^2").exponents[Unit::time], -2);
  EXPECT_DOUBLE_EQ(unit("km/h").scale, 1 / 3.6);
  EXPECT_TRUE(unit("m/s/s").same_dimension(unit("m/s^2")));
  EXPECT_TRUE(unit("1/s").same_dimension(unit("Hz")));
  EXPECT_TRUE(unit("rev/min").same_dimension(unit("rpm")));
  EXPECT_TRUE(unit("machine unit/s").same_dimension(unit("machine unit * Hz")));
  EXPECT_FALSE(unit("rpm").same_dimension(unit("Hz"))) << "an angle is a dimension";
  EXPECT_TRUE(unit("1").same_dimension(unit("%")));
  EXPECT_EQ(unit(" m / s ^ 2 ").name, "m / s ^ 2");
}

TEST(Unit, ReadsBothLettersForMicro) {
  EXPECT_DOUBLE_EQ(unit("\u00B5s").scale, 1e-6);  // micro sign
  EXPECT_DOUBLE_EQ(unit("\u03BCs").scale, 1e-6);  // Greek mu
  EXPECT_DOUBLE_EQ(unit("\u00B5m").scale, 1e-6);
  EXPECT_DOUBLE_EQ(unit("\u03BCm").scale, 1e-6);
  for (const char* const microvolt : {"uV", "\u00B5V", "\u03BCV"}) {
    EXPECT_DOUBLE_EQ(unit(microvolt).scale, 1e-6) << microvolt;
    EXPECT_TRUE(unit(microvolt).same_dimension(unit("V"))) << microvolt;
  }
}

TEST(Unit, IsEmptyWhereTheTextIsNone) {
  for (const char* const text :
       {"", " ", "furlong", "m/", "/s", "m//s", "m^", "m^0", "m^-1", "m^10", "m^x", "m s", "2"}) {
    EXPECT_FALSE(parse_unit(text)) << "'" << text << "'";
  }
}

TEST(Quantity, IsGivenInTheWantedUnit) {
  EXPECT_DOUBLE_EQ(quantity("60 rpm", "rad/s"), 2 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(quantity("30 deg", "rad"), std::numbers::pi / 6);
  EXPECT_DOUBLE_EQ(quantity("30°", "rad"), std::numbers::pi / 6);
  EXPECT_DOUBLE_EQ(quantity("10 kHz", "Hz"), 10000);
  EXPECT_DOUBLE_EQ(quantity("1/2 s", "s"), 0.5);
  EXPECT_DOUBLE_EQ(quantity("1/2 s", "ms"), 500);
  EXPECT_DOUBLE_EQ(quantity("2 1/s", "Hz"), 2);
  EXPECT_DOUBLE_EQ(quantity("5 mm/s^2", "m/s^2"), 5e-3);
  EXPECT_DOUBLE_EQ(quantity("(1+1)*10 mm", "m"), 0.02);
  EXPECT_DOUBLE_EQ(quantity("5%", "1"), 0.05);
  EXPECT_DOUBLE_EQ(quantity("5 min", "s"), 300) << "min is a unit here, no function";
  EXPECT_DOUBLE_EQ(quantity("2 in", "mm"), 50.8);
}

TEST(Quantity, WithoutAUnitIsInTheWantedOne) {
  EXPECT_EQ(quantity("2*pi/3", "rad"), 2 * std::numbers::pi / 3);
  EXPECT_EQ(quantity("2*pi/3", "deg"), 2 * std::numbers::pi / 3);
  EXPECT_EQ(quantity(" 7 ", "mm"), 7);
  EXPECT_TRUE(std::isinf(quantity("inf", "Hz")));
}

TEST(Quantity, SaysWhichUnitWasMeant) {
  EXPECT_EQ(quantity_message("60 rmp", "rad/s"),
            "4: there is no unit 'rmp'; expected a quantity in 'rad/s'; did you mean 'rpm'?");
  EXPECT_EQ(quantity_message("60 rpms", "rad/s"),
            "4: there is no unit 'rpms'; expected a quantity in 'rad/s'; did you mean 'rpm'?");
  EXPECT_EQ(quantity_message("30 dge", "rad"),
            "4: there is no unit 'dge'; expected a quantity in 'rad'; did you mean 'deg'?");
  EXPECT_EQ(quantity_message("30 grade", "rad"),
            "4: there is no unit 'grade'; expected a quantity in 'rad'; known: rad, mrad, deg, °, º, rev");
  EXPECT_EQ(quantity_message("30 rads", "rad"),
            "4: there is no unit 'rads'; expected a quantity in 'rad'; did you mean 'rad'?");
}

TEST(Quantity, WithAUnitWhereNoneBelongsSaysSo) {
  EXPECT_EQ(quantity_message("10 Hz", "1"),
            "4: 'Hz' is the wrong unit here; expected a number without a unit; leave the unit out");
  EXPECT_EQ(quantity_message("1k", "1"),
            "2: there is no unit 'k'; expected a number without a unit; known: 1, %");
}

TEST(Quantity, SaysHowToWriteAProduct) {
  EXPECT_EQ(quantity_message("2 pi", "rad"),
            "3: there is no unit 'pi'; expected a quantity in 'rad'; a product is written with '*': 2*pi");
  EXPECT_EQ(
      quantity_message("2 pi rad", "rad"),
      "3: there is no unit 'pi rad'; expected a quantity in 'rad'; a product is written with '*': 2*pi rad");
  EXPECT_EQ(quantity_message("2 (1+1)", "1"),
            "3: there is no unit '(1+1)'; expected a number without a unit; a product is written with '*': "
            "2*(1+1)");
}

TEST(Quantity, CountsTurnsWhereOneIsWantedAndTheOtherGiven) {
  EXPECT_DOUBLE_EQ(quantity("60 rpm", "Hz"), 1);
  EXPECT_DOUBLE_EQ(quantity("360 deg/s", "Hz"), 1);
  EXPECT_DOUBLE_EQ(quantity("1 rad/s", "Hz"), 1 / (2 * std::numbers::pi));
  EXPECT_DOUBLE_EQ(quantity("3000 1/min", "Hz"), 50);
  EXPECT_DOUBLE_EQ(quantity("50 Hz", "rad/s"), 100 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(quantity("2 kHz", "rad/s"), 4000 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(quantity("60 1/min", "rad/s"), 2 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(quantity("90º", "rad"), std::numbers::pi / 2);
}

/// A unit of signals on a machine of so many volts; 0: they are not known.
Unit signal(std::string_view name, double volts) {
  Unit wanted = unit(name);
  wanted.machine = "ec-1";
  if (volts > 0) wanted.volts = volts;
  return wanted;
}

TEST(Quantity, TakesVoltagesForSignalsOfAMachine) {
  EXPECT_DOUBLE_EQ(parse_quantity("30 V", signal("machine unit", 60)), 0.5);
  EXPECT_DOUBLE_EQ(parse_quantity("-600 mV", signal("machine unit", 60)), -0.01);
  EXPECT_DOUBLE_EQ(parse_quantity("6 V/ms", signal("machine unit/s", 60)), 100);
  EXPECT_DOUBLE_EQ(parse_quantity("50 %", signal("machine unit", 60)), 0.5);
  EXPECT_DOUBLE_EQ(parse_quantity("0.25", signal("machine unit", 60)), 0.25);
  EXPECT_THROW(parse_quantity("30 V^2", signal("machine unit", 60)), ExpressionError);
  EXPECT_THROW(parse_quantity("30 V", signal("machine unit/s", 60)), ExpressionError);
}

TEST(Quantity, RefusesVoltagesOfAMachineWithoutVolts) {
  try {
    parse_quantity("30 V", signal("machine unit", 0));
    FAIL() << "was taken";
  } catch (const ExpressionError& error) {
    EXPECT_EQ(error.what, "'V' is a voltage, and the unit of the machine 'ec-1' is no known voltage");
    EXPECT_EQ(error.expected, "a quantity in 'machine unit'");
    EXPECT_EQ(
        error.remedy,
        "name the machine, profile = \"ec-1\" in [machine], or divide by its greatest voltage: 30 V of 60 V "
        "are 0.5");
  }
}

TEST(Quantity, TakesTypesetSignsAndSpaces) {
  EXPECT_DOUBLE_EQ(quantity("\u22123\u00a0mm", "m"), -0.003);
  EXPECT_DOUBLE_EQ(quantity("5 \u2013 2\u00d73", "1"), -1);
  EXPECT_DOUBLE_EQ(quantity("2\u00b7pi", "rad"), 2 * std::numbers::pi);
}

TEST(Quantity, AsksForADecimalPoint) {
  EXPECT_EQ(quantity_message("0,5 mm", "m"),
            "2: there is a comma in the number; expected a decimal point; write 0.5 mm");
}

TEST(Quantity, RefusesTheWrongDimension) {
  EXPECT_EQ(
      quantity_message("10 1/s", "rad/s"),
      "4: '1/s' is the wrong unit here; expected a quantity in 'rad/s'; of radians give it in 'rad/s', of "
      "turns in 'Hz' or 'rpm'");
  EXPECT_EQ(
      quantity_message("30 V", "machine unit"),
      "4: 'V' is the wrong unit here; expected a quantity in 'machine unit'; give it in 'machine unit', or "
      "as a number without a unit");
  EXPECT_EQ(quantity_message("3 mm", "s"),
            "3: 'mm' is the wrong unit here; expected a quantity in 's'; give it in 's', or as a number "
            "without a unit");
}

TEST(Quantity, PassesOnTheErrorsOfItsExpression) {
  EXPECT_EQ(quantity_message("", "m"), "1: the expression ends too early; expected a number, a name or '('");
  EXPECT_EQ(quantity_message("mm", "m"), "1: 'mm' is not a known constant; expected a number, 'pi' or 'inf'");
  EXPECT_EQ(quantity_message("1e400 m", "m"),
            "1: the number is out of range; expected a magnitude between 2.3e-308 and 1.7e308");
}

TEST(Quantity, AsksTheLookupForNames) {
  const NameLookup lookup = [](std::string_view name) -> std::optional<double> {
    return name == "width" ? std::optional(3.0) : std::nullopt;
  };
  EXPECT_DOUBLE_EQ(parse_quantity("2*width mm", unit("m"), lookup), 6e-3);
}

// There and back again is the identity; each of the four roundings costs at most half a unit in the last
// place, which 1e-15 relative covers.
RC_GTEST_PROP(Quantity, SurvivesTheWayThroughAnotherUnit, ()) {
  const auto pair =
      *rc::gen::element(std::pair{"mm", "in"}, std::pair{"rpm", "rad/s"}, std::pair{"deg", "rev"},
                        std::pair{"kHz", "1/s"}, std::pair{"km/h", "ft/min"});
  const double number = *rc::gen::inRange(1, 1'000'000);
  const double there = quantity(std::to_string(static_cast<int>(number)) + " " + pair.first, pair.second);
  const double back = there * (unit(pair.second).scale / unit(pair.first).scale);
  RC_ASSERT(std::abs(back - number) <= 1e-15 * number);
}

TEST(Quantity, TakesTheUnitOfTheOtherBoundWhereItHasNone) {
  EXPECT_EQ(parse_quantity(with_unit_of("1", "2 mm"), *parse_unit("m")), 1e-3);
  EXPECT_EQ(parse_quantity(with_unit_of("3/2", "2mm"), *parse_unit("mm")), 1.5);
  EXPECT_EQ(parse_quantity(with_unit_of("1 cm", "20 mm"), *parse_unit("mm")), 10);
  EXPECT_EQ(parse_quantity(with_unit_of("1", "2"), *parse_unit("m")), 1);
  EXPECT_EQ(with_unit_of("", "2 mm"), "") << "is refused as it stands";
  EXPECT_EQ(parse_quantity("2 d", *parse_unit("h")), 48);
}

}  // namespace
}  // namespace oblique::text
