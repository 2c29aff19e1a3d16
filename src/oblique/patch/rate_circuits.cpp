// SPDX-License-Identifier: MIT
#include <oblique/patch/rate_circuits.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include <oblique/mechanism/model/law_derivative.h>
#include <oblique/patch/descent.h>
#include <oblique/patch/drive_circuits.h>
#include <oblique/patch/signal_rates.h>
#include <oblique/text/expression_printer.h>

namespace oblique::patch {
namespace {

/// Between two positions of the motion a signal may rise a little more.
constexpr double kMargin = 1.001;

class RateWriter {
 public:
  explicit RateWriter(Circuit& circuit)
      : circuit_(circuit),
        setup_(circuit.setup),
        mechanism_(setup_.mechanism()),
        writer_(circuit.writer),
        places_(mechanism_, setup_.scaling) {
    double fastest = 0, largest = 0;
    for (const mechanism::Configuration& here : setup_.motion.configurations) {
      for (const mechanism::PointState& point : here.points) {
        fastest = std::max(fastest, point.velocity.cwiseAbs().maxCoeff());
        largest = std::max(largest, point.acceleration.cwiseAbs().maxCoeff());
      }
    }
    result_.velocity_unit = fastest > 0 ? round_scale_up(fastest) : 1;
    result_.acceleration_unit = largest > 0 ? round_scale_up(largest) : 1;
    result_.points.resize(mechanism_.points.size());
    units_ = {result_.velocity_unit / setup_.scaling.length,
              result_.acceleration_unit / setup_.scaling.length};
  }

  RateCircuits run() {
    const std::string& length = mechanism_.length_unit;
    writer_.diagram().comment +=
        fmt::format("\nRates: 1 machine unit = {:.6g} {}/s and {:.6g} {}/s^2.",
                    result_.velocity_unit / setup_.time.factor, length,
                    result_.acceleration_unit / (setup_.time.factor * setup_.time.factor), length);
    for (std::size_t d = 0; d < circuit_.drives.size(); ++d) add_drive(d);
    for (const mechanism::Group& group : setup_.structure.groups) {
      if (group.form.placing == mechanism::Placing::rotation) {
        add_crank(group);
      } else {
        add_group(group);
      }
      for (const std::size_t point : group.points) places_.set_signals(point, circuit_.places.signals(point));
    }
    return std::move(result_);
  }

 private:
  using Order = SignalRates::Order;
  using enum SignalRates::Order;

  /// A form whose rate has a block.
  struct FormRate {
    std::string signal;  ///< empty where the form never changes
    double unit = 0;     ///< 1 machine unit of the signal, in the units of rates
  };

  // --- what is known

  void add_drive(std::size_t d) {
    const DriveSpeed& speed = circuit_.speeds[d];
    const DriveForms& forms = circuit_.drives[d];
    std::string acceleration;  // its signal, in its unit; none at constant speed
    double acceleration_unit = 0;
    if (mechanism_.drives[d].law) std::tie(acceleration, acceleration_unit) = add_acceleration(d);
    if (mechanism_.drives[d].slide) {
      const auto& [way, reach] = *forms.way.weights.begin();
      auto& [of_way, exact] = rates_[way];
      of_way[first] = weighted(speed.signal, setup_.scaled(speed.unit) / reach / units_[first]);
      if (!acceleration.empty())
        of_way[second] = weighted(acceleration, setup_.scaled(acceleration_unit) / reach / units_[second]);
      for (const std::vector<mechanism::DriveState>& row : setup_.motion.drives) {
        exact[first].push_back(setup_.scaled(row[d].rate) / reach);
        exact[second].push_back(setup_.scaled(row[d].acceleration) / reach);
      }
      return;
    }
    const std::string& cos = forms.axis.x.weights.begin()->first;
    const std::string& sin = forms.axis.y.weights.begin()->first;
    auto& [of_cos, exact_cos] = rates_[cos];
    auto& [of_sin, exact_sin] = rates_[sin];
    // d cos = −φ̇ sin, d² cos = −φ̇² cos − φ̈ sin, and so on
    const std::string& u = speed.signal;
    const std::string u_cos = by_speed(d, u, cos), u_sin = by_speed(d, u, sin);
    const double w = speed.unit / units_[first], w2 = speed.unit * speed.unit / units_[second];
    of_cos[first] = weighted(u_sin, -w);
    of_sin[first] = weighted(u_cos, w);
    of_cos[second] = weighted(by_speed(d, u, u_cos), -w2);
    of_sin[second] = weighted(by_speed(d, u, u_sin), -w2);
    if (!acceleration.empty()) {
      of_cos[second].add(weighted(product(acceleration, sin), -acceleration_unit / units_[second]));
      of_sin[second].add(weighted(product(acceleration, cos), acceleration_unit / units_[second]));
    }
    for (const std::vector<mechanism::DriveState>& row : setup_.motion.drives) {
      const double rate = row[d].rate, alpha = row[d].acceleration;
      const double c = std::cos(row[d].value), s = std::sin(row[d].value);
      exact_cos[first].push_back(-rate * s);
      exact_sin[first].push_back(rate * c);
      exact_cos[second].push_back(-rate * rate * c - alpha * s);
      exact_sin[second].push_back(-rate * rate * s + alpha * c);
    }
  }

  /// The derivative of a drive's law: its signal and what 1 machine unit of it is. No signal where it
  /// vanishes.
  std::pair<std::string, double> add_acceleration(std::size_t d) {
    const mechanism::Drive& drive = mechanism_.drives[d];
    double largest = 0;
    for (const std::vector<mechanism::DriveState>& row : setup_.motion.drives)
      largest = std::max(largest, std::abs(row[d].acceleration));
    if (largest == 0) return {};
    const double unit = round_up(kMargin * largest);
    return {writer_.add_block(
                drive.name + "_acceleration", "time-function",
                {diagram::text_setting("formula", text::to_string(mechanism::law_derivative(*drive.law))),
                 diagram::number_setting("scale", drive.law_scale / unit)}),
            unit};
  }

  /// A signal times that of a drive's speed, which is 1 where the speed is constant.
  std::string by_speed(std::size_t d, const std::string& speed, const std::string& signal) {
    return mechanism_.drives[d].law ? product(speed, signal) : signal;
  }

  std::string product(const std::string& a, const std::string& b) {
    std::string name = a + "_" + b;
    std::replace(name.begin(), name.end(), '.', '_');
    return writer_.add_product(name, a, b);
  }

  void add_crank(const mechanism::Group& crank) {
    const std::size_t d = crank.drives.front();
    const mechanism::Body& body = mechanism_.bodies[mechanism_.drives[d].body];
    const std::size_t begin = writer_.diagram().blocks.size();
    for (const mechanism::BodyPoint& point : body.points) {
      if (places_.has(point.point)) continue;
      name_rates(point.point);
      add_summed_rates(point.point, crank_point(places_, circuit_.drives[d], crank, point));
    }
    comment(begin, fmt::format("rates of the crank {}", body.name));
  }

  // --- the rates of points

  /// Names the signals of a point's rates, and says what they will be.
  void name_rates(std::size_t point) {
    RateSignals& names = result_.points[point];
    const std::string& name = setup_.name_of(point);
    names = {writer_.free_name(name + "_vx"), writer_.free_name(name + "_vy"),
             writer_.free_name(name + "_ax"), writer_.free_name(name + "_ay")};
    const PointSignals& at = circuit_.places.signals(point);
    SignalRates::Rates &x = rates_[at.x], &y = rates_[at.y];
    x.forms = {weighted(names.vx), weighted(names.ax)};
    y.forms = {weighted(names.vy), weighted(names.ay)};
    for (const mechanism::Configuration& here : setup_.motion.configurations) {
      const mechanism::PointState& exact = here.points[point];
      x.exact[first].push_back(setup_.scaled(exact.velocity.x()));
      y.exact[first].push_back(setup_.scaled(exact.velocity.y()));
      x.exact[second].push_back(setup_.scaled(exact.acceleration.x()));
      y.exact[second].push_back(setup_.scaled(exact.acceleration.y()));
    }
  }

  void add_summed_rates(std::size_t point, const VectorForm& at) {
    const RateSignals& names = result_.points[point];
    writer_.add_named(names.vx, "summer", {sum_of(writer_.terms_of(rates_.of(at.x, first)))});
    writer_.add_named(names.vy, "summer", {sum_of(writer_.terms_of(rates_.of(at.y, first)))});
    writer_.add_named(names.ax, "summer", {sum_of(writer_.terms_of(rates_.of(at.x, second)))});
    writer_.add_named(names.ay, "summer", {sum_of(writer_.terms_of(rates_.of(at.y, second)))});
  }

  // --- groups

  void add_group(const mechanism::Group& group) {
    std::vector<std::size_t> unknowns;
    const std::vector<Residual> conditions =
        residuals_of(group, places_, setup_.scaling, circuit_.drives, [&](std::size_t point) {
          unknowns.push_back(point);
          name_rates(point);
          places_.set_signals(point, circuit_.places.signals(point));
        });
    const std::size_t begin = writer_.diagram().blocks.size();
    Gradients gradients[2];
    for (Gradients& gradient : gradients) {
      for (const std::size_t point : unknowns) {
        gradient[circuit_.places.signals(point).x];
        gradient[circuit_.places.signals(point).y];
      }
    }
    for (const Residual& residual : conditions) add_residual(residual, gradients);
    for (const std::size_t point : unknowns) {
      const RateSignals& names = result_.points[point];
      const PointSignals& at = circuit_.places.signals(point);
      add_servo(names.vx, gradients[first][at.x]);
      add_servo(names.vy, gradients[first][at.y]);
      add_servo(names.ax, gradients[second][at.x]);
      add_servo(names.ay, gradients[second][at.y]);
    }
    for (const std::size_t point : group.points) {
      if (!result_.points[point].vx.empty()) continue;
      name_rates(point);
      add_summed_rates(point, places_.at(point));
    }
    comment(begin,
            fmt::format("rates of the group {}: its conditions, differentiated once and twice", group.name));
  }

  /// Comments on the blocks from the one with this index on, if there are any.
  void comment(std::size_t begin, const std::string& text) {
    if (begin < writer_.diagram().blocks.size()) writer_.diagram().blocks[begin].comment = text;
  }

  /// The derivatives of one condition, and what they pull at.
  void add_residual(const Residual& residual, Gradients (&gradients)[2]) {
    std::vector<std::string> forms;
    std::vector<FormRate> rates[2];
    for (const auto& [name, form] : residual.forms) {
      forms.push_back(form_block(name, form));
      for (const Order order : {first, second}) rates[order].push_back(add_form_rate(name, form, order));
    }
    for (const Order order : {first, second}) {
      Terms sum = writer_.terms_of(rates_.of(residual.rest, order));
      if (sum.size() == 1 && sum.front().weight == 0) sum.clear();
      for (const Residual::Product& p : residual.products) {
        const FormRate &a = rates[order][p.a], &b = rates[order][p.b];
        const double twice = p.a == p.b ? 2 : 1;
        if (!a.signal.empty()) sum.push_back({twice * p.weight * a.unit, product(a.signal, forms[p.b])});
        if (p.a != p.b && !b.signal.empty())
          sum.push_back({p.weight * b.unit, product(forms[p.a], b.signal)});
        if (order == first) continue;
        const FormRate &va = rates[first][p.a], &vb = rates[first][p.b];
        if (va.signal.empty() || vb.signal.empty()) continue;
        const double unit = va.unit * vb.unit * units_[first] * units_[first] / units_[second];
        sum.push_back({2 * p.weight * unit, product(va.signal, vb.signal)});
      }
      const std::string gap = writer_.add_block(residual.name + (order == first ? "_v_gap" : "_a_gap"),
                                                "summer", {diagram::wire_setting("in", sum)});
      add_gradients(writer_, residual, forms, gap, gradients[order]);
    }
  }

  void add_servo(const std::string& name, const Terms& gradient) {
    Terms in = gradient;
    for (diagram::WeightedSignal& term : in) term.weight *= kInputGain;
    writer_.add_named(name, "servo-amplifier",
                      {diagram::wire_setting("in", in), diagram::number_setting("gain", setup_.options.gain),
                       diagram::number_setting("bandwidth", setup_.bandwidth)});
  }

  // --- forms

  /// The block of a form, which the positions may have already.
  std::string form_block(const std::string& name, const LinearForm& form) {
    for (const auto& [known, block] : circuit_.form_blocks) {
      if (known == form) return block;
    }
    std::string block = writer_.add_summer(name, form);
    circuit_.form_blocks.emplace_back(form, block);
    return block;
  }

  /// The rate of a form, scaled to stay within ±1 along the exact motion.
  FormRate add_form_rate(const std::string& name, const LinearForm& form, Order order) {
    const LinearForm rate = rates_.of(form, order);
    if (rate.weights.empty() && rate.constant == 0) return {};
    // Beside what the motion makes of it, which may be nothing, the form has to carry the loops' errors.
    constexpr double kLeast = 1e-3;
    const double unit = round_up(std::max(kMargin * rates_.largest(form, order) / units_[order], kLeast));
    LinearForm scaled_rate;
    scaled_rate.add(rate, 1 / unit);
    return {writer_.add_summer(name + (order == first ? "_v" : "_a"), scaled_rate), unit};
  }

  Circuit& circuit_;
  const PatchSetup& setup_;
  const mechanism::Mechanism& mechanism_;
  CircuitWriter& writer_;
  PointBook places_;  ///< of the conditions: signals for unknowns, forms for what follows from them
  RateCircuits result_;
  std::array<double, 2> units_;  ///< 1 machine unit of a rate, in machine units of a coordinate [1/s], [1/s²]
  SignalRates rates_;            ///< of the signals of points and drives
};

}  // namespace

RateCircuits add_rates(Circuit& circuit) {
  return RateWriter(circuit).run();
}

}  // namespace oblique::patch
