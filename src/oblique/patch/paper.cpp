// SPDX-License-Identifier: MIT
// Mechanism → diagram as the source (AVM class III) draws it: two equal four-bar circuits and a loop.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/patch/triad_patch.h>

namespace oblique::patch {
namespace {

class PaperPatch : private TriadPatch {
 public:
  using TriadPatch::TriadPatch;

  diagram::Diagram make() {
    for (const mechanism::Group& group : structure_.groups) {
      if (group.form.placing == mechanism::Placing::rotation || group.form.is_triad_on_links()) continue;
      refuse(group, "is not of the source's kind", "cranks and triads on three links, as the source has them",
             group.assur_class == 2 ? text::Remedy{"patch it with ", text::Setting{"method", "triangles"}}
                                    : text::Remedy{"patch it with ", text::Setting{"method", "gradient"},
                                                   ", which takes any group"});
    }
    check_split_options(mechanism_, structure_, options_);
    choose_splits();
    describe("patched as the source draws it",
             fmt::format("Two equal four-bar circuits for each class III group, one scale for all lengths.\n"
                         "Servo amplifiers: gain {}, bandwidth {} Hz. Run over {}.",
                         options_.gain, bandwidth_, span_text()));
    add_reference();
    std::size_t triad = 0;
    for (const mechanism::Group& group : structure_.groups) {
      if (group.form.placing == mechanism::Placing::rotation) {
        const std::string generator = add_crank(group);
        add_output(angles_.empty() ? "phi" : generator, generator + ".cos", generator + ".sin");
        for (const std::size_t point : group.points) set_known(point);
      } else {
        suffix_ = triad == 0 ? "" : fmt::format("_{}", triad + 1);
        add_circuits(group, splits_[triad++]);
      }
    }
    if (options_.derivatives) add_rates();
    add_outputs();
    for (diagram::OutputSpec& angle : angles_) diagram_.outputs.push_back(std::move(angle));
    return std::move(diagram_);
  }

 private:
  /// The source's split, unless the options name one; and the scale grows to hold the variable lengths.
  void choose_splits() {
    double longest = scaling_.length;
    for (const mechanism::Group& group : structure_.groups) {
      if (!group.form.is_triad_on_links()) continue;
      PatchOptions options = options_;
      if (!names_leads_of(group)) options.split = split_of_the_source(group);
      splits_.push_back(choose_split(mechanism_, group, motion_, options));
      longest = std::max({longest, splits_.back().reach, splits_.back().second_reach});
    }
    if (!options_.unit) scaling_.length = round_scale_up(longest);
    set_scale(scaling_);
  }

  bool names_leads_of(const mechanism::Group& group) const {
    std::vector<std::string> legs;
    for (std::size_t k = 0; k < group.equations.conditions.size(); ++k)
      legs.push_back(mechanism_.bodies[leg_of(group, k)].name);
    return std::is_permutation(legs.begin(), legs.end(), options_.split.begin(), options_.split.end());
  }

  /// The lead on a moving point carries the variable length, as AB does; of the others the last one in the
  /// file closes the loop, as O′C does.
  std::vector<std::string> split_of_the_source(const mechanism::Group& group) const {
    const auto& conditions = group.equations.conditions;
    std::size_t tracked = 0;
    for (std::size_t k = conditions.size(); k-- > 0;) {
      if (!mechanism_.points[conditions[k].b.point].fixed) tracked = k;
    }
    std::vector<std::size_t> others;
    for (std::size_t k = 0; k < conditions.size(); ++k) {
      if (k != tracked) others.push_back(leg_of(group, k));
    }
    std::sort(others.begin(), others.end());
    return {mechanism_.bodies[leg_of(group, tracked)].name, mechanism_.bodies[others[1]].name,
            mechanism_.bodies[others[0]].name};
  }

  void add_circuits(const mechanism::Group& group, const TriadSplit& split) {
    const auto& conditions = group.equations.conditions;
    const mechanism::Condition& tracked = conditions[split.tracked];
    const mechanism::Condition& closing = conditions[split.closing];
    const mechanism::Condition& third = conditions[split.third];
    const std::size_t a = tracked.b.point, b = tracked.a.point;
    const std::size_t z = closing.b.point, c = closing.a.point;
    const std::size_t e = third.b.point, d = third.a.point;
    const std::string length = free_name(name_of(z) + name_of(b));
    const Eigen::Vector2d bone = third.a.local - tracked.a.local, arm = closing.a.local - tracked.a.local;
    const double xi = std::atan2(mechanism::cross(bone, arm), bone.dot(arm));
    const std::string first = add_circuit(
        "circuit_" + name_of(a) + name_of(b) + name_of(z), a, z, b, {{1, length}}, tracked.value,
        split.first_side,
        fmt::format("triad {}, split {}. The four-bar …{}{}{} with the length {}{} taken for known:\n"
                    "angles ψ, γ and α of {}{}",
                    group.name, split_name(mechanism_, group, split), name_of(a), name_of(b), name_of(z),
                    name_of(z), name_of(b), name_of(a), name_of(b)));
    signals_[b] = {first + ".x", first + ".y"};
    const std::string second =
        add_circuit("circuit_" + name_of(z) + name_of(b) + name_of(d) + name_of(e), b, e, d,
                    {{scaled(third.value), one_}}, bone.norm(), split.second_side,
                    fmt::format("the four-bar {}{}{}{}: its α is ε, the direction of {}{}", name_of(z),
                                name_of(b), name_of(d), name_of(e), name_of(b), name_of(d)));
    signals_[d] = {second + ".x", second + ".y"};
    add_angle("psi", first, "psi");
    add_angle("gamma", first, "gamma");
    add_angle("alpha", first, "alpha");
    add_angle("epsilon", second, "alpha");
    add_direction("beta", e, d, scaled(third.value),
                  fmt::format("β, the direction of {}{}", name_of(e), name_of(d)));
    // C = B + BC (cos(ε + ξ), sin(ε + ξ))
    const double cosine = std::cos(xi), sine = std::sin(xi);
    const std::string cos_eps = second + ".cos_alpha", sin_eps = second + ".sin_alpha";
    const std::string cos_sum =
        add_block("cos_epsilon_xi", "summer", {sum_of({{cosine, cos_eps}, {-sine, sin_eps}})},
                  fmt::format("ε + ξ, the direction of {}{}: ξ = {:.6g}° is a pair of potentiometers",
                              name_of(b), name_of(c), xi * 180 / std::numbers::pi));
    const std::string sin_sum =
        add_block("sin_epsilon_xi", "summer", {sum_of({{cosine, sin_eps}, {sine, cos_eps}})});
    const double bc = scaled(arm.norm());
    add_summed_point(c, {x_of(b, 1), {bc, cos_sum}}, {y_of(b, 1), {bc, sin_sum}}, {});
    set_known(c);
    carry_triad(group, b, d);
    close(closing, split, length);
  }

  std::string add_circuit(const std::string& name, std::size_t p, std::size_t q, std::size_t joint,
                          const Terms& rocker, double coupler, int side, const std::string& comment) {
    const TriangleStart start = triangle_start(p, q, joint);
    // ψ is the direction of O′A, clockwise
    std::vector<text::Entry> settings;
    for (const auto& [port, term] : {std::pair("px", x_of(p, 1)), std::pair("py", y_of(p, 1)),
                                     std::pair("qx", x_of(q, 1)), std::pair("qy", y_of(q, 1))}) {
      if (term.weight != 0) settings.push_back(diagram::wire_setting(port, {term}));
    }
    settings.push_back(diagram::wire_setting("rocker", rocker));
    const std::initializer_list<std::pair<const char*, double>> numbers{
        {"coupler", scaled(coupler)},
        {"side", side},
        {"start_diagonal", scaled(start.length)},
        {"start_cos_psi", -start.cosine},
        {"start_sin_psi", start.sine},
        {"start_cos_gamma", start.angle_cosine},
        {"start_sin_gamma", start.angle_sine}};
    for (const auto& [parameter, value] : numbers)
      settings.push_back(diagram::number_setting(parameter, value));
    return add_block(name, "four-bar-circuit", with_amplifiers(std::move(settings)), comment);
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
    const std::string cosine = add_block("cos_" + name, "summer",
                                         {sum_of({x_of(to, 1 / length), x_of(from, -1 / length)})}, comment);
    const std::string sine =
        add_block("sin_" + name, "summer", {sum_of({y_of(to, 1 / length), y_of(from, -1 / length)})});
    add_output(name, cosine, sine);
  }

  /// |ZC|² − x_C² − y_C², in the frame of Z, drives the variable length.
  void close(const mechanism::Condition& closing, const TriadSplit& split, const std::string& length) {
    const std::size_t z = closing.b.point, c = closing.a.point;
    const std::string dx = add_block(length + "_dx", "summer", {sum_of({x_of(c, 1), x_of(z, -1)})});
    const std::string dy = add_block(length + "_dy", "summer", {sum_of({y_of(c, 1), y_of(z, -1)})});
    const std::string dx2 =
        add_block(length + "_dx2", "multiplier", {diagram::wire_setting("in", {{1, dx}, {1, dx}})});
    const std::string dy2 =
        add_block(length + "_dy2", "multiplier", {diagram::wire_setting("in", {{1, dy}, {1, dy}})});
    const double l = scaled(closing.value), sign = split.sign;
    add_outer_loop(length, {{sign, dx2}, {sign, dy2}, {-sign * l * l, one_}}, scaled(split.first_w));
  }

  std::vector<TriadSplit> splits_;  ///< of the triads, in the order of the groups
  std::vector<diagram::OutputSpec> angles_;
  std::set<std::string> angle_names_;
  std::string suffix_;  ///< of the names of angles, from the second triad on
};

}  // namespace

diagram::Diagram patch_paper(const mechanism::Mechanism& mechanism, const PatchOptions& options) {
  return PaperPatch(mechanism, options).make();
}

}  // namespace oblique::patch
