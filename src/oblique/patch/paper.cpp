// SPDX-License-Identifier: MIT
#include <oblique/patch/paper.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include <oblique/mechanism/model/plane.h>
#include <oblique/patch/circuit_frame.h>
#include <oblique/patch/drive_circuits.h>
#include <oblique/patch/point_circuits.h>
#include <oblique/patch/triad_circuits.h>

namespace oblique::patch {
namespace {

void check_groups_of_the_source(const PatchSetup& setup) {
  for (const mechanism::Group& group : setup.structure.groups) {
    if (group.form.placing == mechanism::Placing::rotation || group.form.is_triad_on_links()) continue;
    refuse(setup.mechanism(), group, "is of a kind that the source does not have",
           "cranks and triads on three links, as the source has them",
           group.assur_class == 2 ? text::Remedy{"patch it with ", text::Setting{"method", "triangles"}}
                                  : text::Remedy{"patch it with ", text::Setting{"method", "gradient"},
                                                 ", which takes any group"});
  }
  check_split_options(setup.mechanism(), setup.structure, setup.options);
}

/// The leg on a moving point carries the variable length, as AB does; of the others the last one in the
/// file closes the loop, as O′C does.
std::vector<std::string> split_of_the_source(const mechanism::Mechanism& mechanism,
                                             const mechanism::Group& group) {
  const auto& conditions = group.equations.conditions;
  std::size_t tracked = 0;
  for (std::size_t k = conditions.size(); k-- > 0;) {
    if (!mechanism.points[conditions[k].b.point].fixed) tracked = k;
  }
  std::vector<std::size_t> others;
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    if (k != tracked) others.push_back(leg_of(group, k));
  }
  std::sort(others.begin(), others.end());
  return {mechanism.bodies[leg_of(group, tracked)].name, mechanism.bodies[others[1]].name,
          mechanism.bodies[others[0]].name};
}

bool names_legs_of(const PatchSetup& setup, const mechanism::Group& group) {
  std::vector<std::string> legs;
  for (std::size_t k = 0; k < group.equations.conditions.size(); ++k)
    legs.push_back(setup.mechanism().bodies[leg_of(group, k)].name);
  const std::vector<std::string>& named = setup.options.split;
  return std::is_permutation(legs.begin(), legs.end(), named.begin(), named.end());
}

/// The splits of the triads, in the order of the groups: the source's, unless the options name one.
std::vector<TriadSplit> choose_splits(const PatchSetup& setup) {
  std::vector<TriadSplit> splits;
  for (const mechanism::Group& group : setup.structure.groups) {
    if (!group.form.is_triad_on_links()) continue;
    PatchOptions options = setup.options;
    if (!names_legs_of(setup, group)) options.split = split_of_the_source(setup.mechanism(), group);
    splits.push_back(choose_split(setup.mechanism(), group, setup.motion, options));
  }
  return splits;
}

/// The scale grows to hold the variable lengths.
void widen(Scaling& scaling, const std::vector<TriadSplit>& splits) {
  double longest = scaling.length;
  for (const TriadSplit& split : splits) longest = std::max({longest, split.reach, split.second_reach});
  scaling.length = round_scale_up(longest);
}

class PaperWriter {
 public:
  explicit PaperWriter(Circuit& circuit)
      : circuit_(circuit), setup_(circuit.setup), writer_(circuit.writer), places_(circuit.places) {}

  void add_crank(const mechanism::Group& group) {
    const std::string generator = patch::add_crank(circuit_, group);
    add_output(angles_.empty() ? "phi" : generator, generator + ".cos", generator + ".sin");
  }

  void add_triad(const mechanism::Group& group, const TriadSplit& split) {
    suffix_ = triads_ == 0 ? "" : fmt::format("_{}", triads_ + 1);
    ++triads_;
    add_circuits(group, split);
  }

  /// Of the angles, after those of the points.
  void add_outputs() {
    for (diagram::OutputSpec& angle : angles_) writer_.diagram().outputs.push_back(std::move(angle));
  }

 private:
  void add_circuits(const mechanism::Group& group, const TriadSplit& split) {
    const auto& conditions = group.equations.conditions;
    const mechanism::Condition& tracked = conditions[split.tracked];
    const mechanism::Condition& closing = conditions[split.closing];
    const mechanism::Condition& third = conditions[split.third];
    const auto [a, b, z, c, e, d] = points_of(group, split);
    const std::string length = writer_.free_name(setup_.name_of(z) + setup_.name_of(b));
    const Eigen::Vector2d bone = third.a.local - tracked.a.local, arm = closing.a.local - tracked.a.local;
    const double xi = std::atan2(mechanism::cross(bone, arm), bone.dot(arm));
    const std::string first = add_circuit(
        "circuit_" + setup_.name_of(a) + setup_.name_of(b) + setup_.name_of(z), a, z, b, {{1, length}},
        tracked.value, split.first_side,
        fmt::format("triad {}, split {}. The four-bar …{}{}{} with the length {}{} taken for known:\n"
                    "angles ψ, γ and α of {}{}",
                    group.name, split_name(setup_.mechanism(), group, split), setup_.name_of(a),
                    setup_.name_of(b), setup_.name_of(z), setup_.name_of(z), setup_.name_of(b),
                    setup_.name_of(a), setup_.name_of(b)));
    places_.set_signals(b, {first + ".x", first + ".y"});
    const std::string second = add_circuit(
        "circuit_" + setup_.name_of(z) + setup_.name_of(b) + setup_.name_of(d) + setup_.name_of(e), b, e, d,
        {{setup_.scaled(third.value), writer_.one()}}, bone.norm(), split.second_side,
        fmt::format("the four-bar {}{}{}{}: its α is ε, the direction of {}{}", setup_.name_of(z),
                    setup_.name_of(b), setup_.name_of(d), setup_.name_of(e), setup_.name_of(b),
                    setup_.name_of(d)));
    places_.set_signals(d, {second + ".x", second + ".y"});
    add_angle("psi", first, "psi");
    add_angle("gamma", first, "gamma");
    add_angle("alpha", first, "alpha");
    add_angle("epsilon", second, "alpha");
    add_direction("beta", e, d, setup_.scaled(third.value),
                  fmt::format("β, the direction of {}{}", setup_.name_of(e), setup_.name_of(d)));
    // C = B + BC (cos(ε + ξ), sin(ε + ξ))
    const double cosine = std::cos(xi), sine = std::sin(xi);
    const std::string cos_eps = second + ".cos_alpha", sin_eps = second + ".sin_alpha";
    const std::string cos_sum =
        writer_.add_block("cos_epsilon_xi", "summer", {sum_of({{cosine, cos_eps}, {-sine, sin_eps}})},
                          fmt::format("ε + ξ, the direction of {}{}: ξ = {:.6g}° is a pair of potentiometers",
                                      setup_.name_of(b), setup_.name_of(c), xi * 180 / std::numbers::pi));
    const std::string sin_sum =
        writer_.add_block("sin_epsilon_xi", "summer", {sum_of({{cosine, sin_eps}, {sine, cos_eps}})});
    const double bc = setup_.scaled(arm.norm());
    add_summed_point(circuit_, c, {x_of(circuit_, b, 1), {bc, cos_sum}},
                     {y_of(circuit_, b, 1), {bc, sin_sum}}, {});
    carry_triad(places_, group, b, d);
    add_formed_points(circuit_, group);
    close(closing, split, length);
  }

  std::string add_circuit(const std::string& name, std::size_t p, std::size_t q, std::size_t joint,
                          const Terms& rocker, double coupler, int side, const std::string& comment) {
    const TriangleStart start = triangle_start(setup_.motion, p, q, joint);
    // ψ is the direction of O′A, clockwise
    std::vector<text::Entry> settings;
    for (const auto& [port, term] :
         {std::pair("px", x_of(circuit_, p, 1)), std::pair("py", y_of(circuit_, p, 1)),
          std::pair("qx", x_of(circuit_, q, 1)), std::pair("qy", y_of(circuit_, q, 1))}) {
      if (term.weight != 0) settings.push_back(diagram::wire_setting(port, {term}));
    }
    settings.push_back(diagram::wire_setting("rocker", rocker));
    const std::initializer_list<std::pair<const char*, double>> numbers{
        {"coupler", setup_.scaled(coupler)},
        {"side", side},
        {"start_diagonal", setup_.scaled(start.length)},
        {"start_cos_psi", -start.cosine},
        {"start_sin_psi", start.sine},
        {"start_cos_gamma", start.angle_cosine},
        {"start_sin_gamma", start.angle_sine}};
    for (const auto& [parameter, value] : numbers)
      settings.push_back(diagram::number_setting(parameter, value));
    return writer_.add_block(name, "four-bar-circuit", with_amplifiers(setup_, std::move(settings)), comment);
  }

  /// Outputs for the cosine and sine of an angle.
  void add_output(const std::string& angle, const std::string& cosine, const std::string& sine) {
    std::string name = angle + suffix_;  // a drive may be called like an angle
    for (int k = 2; !angle_names_.insert(name).second; ++k) name = fmt::format("{}{}_{}", angle, suffix_, k);
    for (const auto& [function, signal] : {std::pair("cos", cosine), std::pair("sin", sine)}) {
      diagram::OutputSpec output;
      output.name = fmt::format("{} {}", function, name);
      output.signal = signal;
      output.unit = "1";
      angles_.push_back(output);
    }
  }

  void add_angle(const std::string& name, const std::string& circuit, const std::string& port) {
    add_output(name, circuit + ".cos_" + port, circuit + ".sin_" + port);
  }

  void add_direction(const std::string& name, std::size_t from, std::size_t to, double length,
                     const std::string& comment) {
    const std::string cosine = writer_.add_block(
        "cos_" + name, "summer",
        {sum_of({x_of(circuit_, to, 1 / length), x_of(circuit_, from, -1 / length)})}, comment);
    const std::string sine =
        writer_.add_block("sin_" + name, "summer",
                          {sum_of({y_of(circuit_, to, 1 / length), y_of(circuit_, from, -1 / length)})});
    add_output(name, cosine, sine);
  }

  /// |ZC|² − x_C² − y_C², in the frame of Z, drives the variable length.
  void close(const mechanism::Condition& closing, const TriadSplit& split, const std::string& length) {
    const std::size_t z = closing.b.point, c = closing.a.point;
    const std::string dx =
        writer_.add_block(length + "_dx", "summer", {sum_of({x_of(circuit_, c, 1), x_of(circuit_, z, -1)})});
    const std::string dy =
        writer_.add_block(length + "_dy", "summer", {sum_of({y_of(circuit_, c, 1), y_of(circuit_, z, -1)})});
    const std::string dx2 = writer_.add_product(length + "_dx2", dx, dx);
    const std::string dy2 = writer_.add_product(length + "_dy2", dy, dy);
    const double l = setup_.scaled(closing.value), sign = split.sign;
    add_outer_loop(circuit_, length, {{sign, dx2}, {sign, dy2}, {-sign * l * l, writer_.one()}},
                   setup_.scaled(split.first_w));
  }

  Circuit& circuit_;
  const PatchSetup& setup_;
  CircuitWriter& writer_;
  PointBook& places_;
  std::vector<diagram::OutputSpec> angles_;
  std::set<std::string> angle_names_;
  int triads_ = 0;
  std::string suffix_;  ///< of the names of angles, from the second triad on
};

}  // namespace

diagram::Diagram patch_paper(const mechanism::Mechanism& mechanism, const PatchOptions& options) {
  PatchSetup setup(mechanism, options);
  check_groups_of_the_source(setup);
  const std::vector<TriadSplit> splits = choose_splits(setup);
  if (!options.unit) widen(setup.scaling, splits);
  Circuit circuit(setup);
  begin_circuit(
      circuit, "patched as the source draws it",
      fmt::format("Two equal four-bar circuits for each class III group, one scale for all lengths.\n"
                  "Servo amplifiers: gain {}, bandwidth {} Hz. Run over {}.",
                  options.gain, setup.bandwidth, span_text(setup.mechanism())));
  PaperWriter paper(circuit);
  auto split = splits.begin();
  for (const mechanism::Group& group : setup.structure.groups) {
    if (group.form.placing == mechanism::Placing::rotation) {
      paper.add_crank(group);
    } else {
      paper.add_triad(group, *split++);
    }
  }
  end_circuit(circuit);
  paper.add_outputs();
  return std::move(circuit.writer.diagram());
}

}  // namespace oblique::patch
