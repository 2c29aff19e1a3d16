// SPDX-License-Identifier: MIT
#include "studio/engine/mechanism_study.h"

#include <algorithm>
#include <cmath>

#include <oblique/diagram/flatten.h>
#include <oblique/draw/linkage/linkage.h>
#include <oblique/draw/picture/svg.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/network/assembly/network.h>
#include <oblique/patch/patch.h>
#include <oblique/patch/triad_split.h>
#include <oblique/report/mode_list.h>
#include <oblique/solve/operating_point/quasi_steady.h>
#include <oblique/solve/solve_error.h>
#include <oblique/solve/stability/poles_along.h>
#include <oblique/synthesis/mode_choice.h>

#include "studio/engine/options.h"
#include "studio/engine/patch_request.h"

namespace oblique::studio {
namespace {

constexpr const char* kSlower = "slower";

mechanism::Mechanism read(const Engine& engine, const std::string& text, const std::string& name) {
  engine.check_size(text, name);
  return mechanism::parse_mechanism(text, name);
}

/// The blocks whose bandwidth is another one where the outer loop is.
std::vector<std::string> outer_amplifiers(const mechanism::Mechanism& mechanism,
                                          patch::PatchOptions options) {
  const auto blocks_of = [&](double slower) {
    options.slower = slower;
    return patch::patch(mechanism, options).blocks;
  };
  const std::vector<diagram::BlockInstance> one = blocks_of(1), other = blocks_of(2);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min(one.size(), other.size()); ++k) {
    if (!(one[k] == other[k])) names.push_back(one[k].name);
  }
  return names;
}

struct Rightmost {
  solve::PoleAt pole;
  double drive = 0;
};

}  // namespace

Answer modes(const Engine& engine, const std::string& text, const std::string& name) {
  return answer([&] {
    const mechanism::Mechanism mechanism = read(engine, text, name);
    mechanism::Structure structure = mechanism::find_groups(mechanism);
    const report::ModesAt start = report::modes_at(mechanism, structure, 0);
    Answer found;
    Json& groups = found.object["groups"] = Json::array();
    for (const mechanism::GroupModes& group : start.groups) {
      if (group.modes.size() < 2) continue;
      Json list = Json::array();
      for (const mechanism::AssemblyMode& mode : group.modes) {
        Json one{{"selected", mode.selected}, {"points", Json::object()}};
        for (std::size_t k = 0; k < mode.points.size(); ++k) {
          one["points"][mechanism.points[mode.points[k]].name] = {mode.positions[k].x(),
                                                                  mode.positions[k].y()};
        }
        const synthesis::ModeChoice choice = synthesis::choose_mode(text, mechanism, mode);
        if (choice.text) {
          draw::LinkageScene scene;
          scene.shown = choice.start;
          if (scene.shown.status != mechanism::Status::open)
            one["svg"] = draw::to_svg(draw::draw_linkage(mechanism, scene));
          one["text"] = *choice.text;
        } else {
          one["why"] = choice.why;
        }
        list.push_back(std::move(one));
      }
      const mechanism::Group& about = structure.groups[group.group];
      groups.push_back({{"name", about.name},
                        {"class", about.assur_class},
                        {"complete", group.complete},
                        {"modes", std::move(list)}});
    }
    return found;
  });
}

Answer splits(const Engine& engine, const std::string& text, const std::string& name) {
  return answer([&] {
    const mechanism::Mechanism mechanism = patch::within_range(read(engine, text, name));
    Answer found;
    Json& list = found.object["splits"] = Json::array();
    for (const patch::NamedSplit& split : patch::all_splits(mechanism)) {
      list.push_back(
          {{"legs", split.legs},
           {"worth", split.split.worth()},
           {"flips",
            split.split.flip == patch::TriadSplit::Flip::none ? Json() : Json(split.split.flip_time)}});
    }
    return found;
  });
}

Answer loops(const Engine& engine, const std::string& text, const std::string& name,
             const std::string& options) {
  return answer([&] {
    constexpr int kMoments = 31, kMostMoments = 721;
    const Options asked(options, {"gain", "bandwidth", kSlower, "method", "split", "period", "moments"});
    const mechanism::Mechanism file = read(engine, text, name);
    patch::PatchOptions how = patch_options(asked);
    how.force = true;
    const int moments = asked.whole("moments", 2, kMostMoments).value_or(kMoments);
    const mechanism::Mechanism moved = patch::within_range(file);
    const std::vector<patch::NamedSplit> all = patch::all_splits(moved);
    if (how.split.empty() && !all.empty() && how.method == patch::PatchMethod::triangles)
      how.split = all.front().legs;
    const diagram::Diagram diagram = patch::patch(file, how);
    const diagram::FlatDiagram flat = diagram::flatten(diagram, *engine.library());
    const network::Program program(network::assemble(flat));

    Answer found;
    Json& json = found.object;
    json["columns"] = {"t", "drive", "real", "imaginary", "signal", "own"};
    json["signals"] = Json::array();
    for (const auto& state : program.states()) json["signals"].push_back(state.name);
    json["split"] = how.split;
    json[kSlower] = how.slower.value_or(patch::kUsualSlower);
    json["bandwidth"] = patch::bandwidth_of(file, how);
    json["outer"] = Json::array();
    if (!all.empty() && how.method != patch::PatchMethod::gradient)
      json["outer"] = outer_amplifiers(file, how);
    json["no_rest"] = nullptr;
    std::vector<solve::Instant> instants;
    try {
      instants = solve::quasi_steady_instants(program, flat, solve::options_of(diagram.run),
                                              static_cast<std::size_t>(moments));
    } catch (const solve::SolveError& error) {
      json["no_rest"] = error.diagnostics().front().what;
    }
    // machine time over that of the motion
    const double period = moved.drives.empty() || !how.period ? 1 : *how.period / mechanism::period(moved);
    mechanism::DriveClock clock(moved);
    std::size_t growing = 0;
    std::optional<Rightmost> rightmost;
    for (const solve::PoleAt& pole : solve::poles_along(flat, program, instants)) {
      const double drive = clock.at(0, pole.time / period).value;
      found.numbers.insert(found.numbers.end(),
                           {pole.time, drive, pole.value.real(), pole.value.imag(),
                            static_cast<double>(pole.state), pole.of_problem ? 1.0 : 0.0});
      if (pole.of_problem) continue;
      if (pole.value.real() > 0) ++growing;
      if (!rightmost || pole.value.real() > rightmost->pole.value.real()) rightmost = Rightmost{pole, drive};
    }
    json["rows"] = found.numbers.size() / json["columns"].size();
    json["growing"] = growing;
    json["rightmost"] = nullptr;
    if (rightmost) {
      json["rightmost"] = {{"real", rightmost->pole.value.real()},
                           {"imaginary", rightmost->pole.value.imag()},
                           {"time", rightmost->pole.time},
                           {"drive", rightmost->drive},
                           {"signal", program.states()[rightmost->pole.state].name}};
    }
    return found;
  });
}

}  // namespace oblique::studio
