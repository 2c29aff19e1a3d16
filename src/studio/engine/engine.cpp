// SPDX-License-Identifier: MIT
#include "studio/engine/engine.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>

#include <fmt/format.h>

#include <oblique/commission/judge.h>
#include <oblique/compare/branch.h>
#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/diagram/flatten.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/comparison_report.h>
#include <oblique/report/file_kind.h>
#include <oblique/report/judgement_text.h>
#include <oblique/report/motion_text.h>
#include <oblique/solve/run.h>

#include "studio/engine/description.h"
#include "studio/engine/drawn.h"
#include "studio/engine/lesson.h"
#include "studio/engine/options.h"
#include "studio/engine/patch_request.h"
#include "studio/engine/patching.h"

namespace oblique::studio {
namespace {

using report::FileKind;

[[noreturn]] void refuse_file(const std::string& name, std::string what, std::string expected,
                              std::string remedy = {}) {
  throw text::ReadError(
      text::Diagnostic{{name, {}}, std::move(what), std::move(expected), std::move(remedy)});
}

void expect_kind(const std::string& text, const std::string& name, FileKind wanted, const char* action) {
  if (report::kind_of_file(text, name) == wanted) return;
  const bool diagram = wanted == FileKind::diagram;
  refuse_file(name,
              fmt::format("this is a {}, and {} is of {}s", diagram ? "mechanism" : "diagram", action,
                          diagram ? "diagram" : "mechanism"),
              diagram ? "a diagram" : "a mechanism");
}

Json columns_of(const std::vector<text::TableColumn>& columns) {
  Json list = Json::array();
  for (const text::TableColumn& column : columns)
    list.push_back({{"name", column.name}, {"unit", column.unit}});
  return list;
}

Json trust_of(const solve::Trust& trust) {
  Json json;
  json["outputs"] = Json::array();
  for (const solve::OutputError& output : trust.outputs) {
    Json one{
        {"name", output.name}, {"size", output.size}, {"largest", output.largest}, {"at_end", output.at_end}};
    one["lost"] = output.lost ? Json(*output.lost) : Json();
    json["outputs"].push_back(std::move(one));
  }
  json["event_shift"] = trust.event_shift;
  json["events_part"] = trust.events_part ? Json(*trust.events_part) : Json();
  json["failure"] = trust.failure;
  return json;
}

/// A time that passes, asked for at every step.
class Deadline {
 public:
  explicit Deadline(double seconds) : seconds_(seconds) {}

  bool passed() const { return passed_; }
  /// Looks at the clock now and then, which costs more than a step.
  bool passes() {
    constexpr std::uint32_t kAsked = 64;
    if (passed_ || ++asked_ % kAsked != 0) return passed_;
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin_;
    return passed_ = taken.count() >= seconds_;
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double seconds_;
  std::uint32_t asked_ = 0;
  bool passed_ = false;
};

}  // namespace

const char* event_name(mechanism::MotionEvent::Kind kind) {
  using Kind = mechanism::MotionEvent::Kind;
  switch (kind) {
    case Kind::limit:
      return "limit";
    case Kind::return_:
      return "return";
    case Kind::change:
      return "change";
    case Kind::infinity:
      return "infinity";
    case Kind::lost:
      break;
  }
  return "lost";
}

Engine::Engine() : Engine(Limits{}) {}

Engine::Engine(const Limits& limits)
    : limits_(limits),
      library_(std::make_shared<const diagram::BlockLibrary>(diagram::BlockLibrary::shipped())) {}

Answer Engine::about() {
  return answer([] {
    Answer said;
    said.object["version"] = OBLIQUE_VERSION;
    said.object["solver"] = OBLIQUE_SOLVER;
    return said;
  });
}

Answer Engine::put_file(const std::string& name, const std::string& content) const {
  return answer([&] {
    check_size(content, name);
    const std::filesystem::path path(name);
    std::error_code trouble;
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), trouble);
    std::ofstream file(path, std::ios::binary);
    if (!file.write(content.data(), static_cast<std::streamsize>(content.size())).flush())
      refuse_file(name, "the file could not be kept", "a name of a file");
    return Answer{};
  });
}

Answer Engine::put_block(const std::string& name, const std::string& text) {
  return answer([&] {
    check_size(text, name);
    auto library = std::make_shared<diagram::BlockLibrary>(*library_);  // consoles keep the one they have
    library->add(diagram::parse_block(text, name + ".toml", name));
    library_ = std::move(library);
    return Answer{};
  });
}

Answer Engine::open(const std::string& text, const std::string& name) const {
  return answer([&] {
    check_size(text, name);
    return Answer{description_of(text, name, *library_), {}};
  });
}

Answer Engine::run(const std::string& text, const std::string& name, const std::string& options) const {
  return answer([&] {
    check_size(text, name);
    constexpr int kMostSamples = 10'000'000;
    const Options asked(options, {"until", "samples", "set", "trust"});
    expect_kind(text, name, FileKind::diagram, "a run");
    diagram::Diagram diagram = diagram::parse_diagram(text, name);
    diagram.run.until = asked.quantity("until", "s").value_or(diagram.run.until);
    if (!(diagram.run.until > 0 && std::isfinite(diagram.run.until)))
      refuse_file(name, fmt::format("the run would end at t = {} s", diagram.run.until),
                  "a finite time above 0");
    std::vector<diagram::ParameterOverride> overrides;
    for (auto& [path, value] : asked.settings("set")) overrides.push_back({path, value});
    const diagram::FlatDiagram flat = diagram::flatten(diagram, *library_, overrides);
    const network::Program program(network::assemble(flat));

    solve::RunOptions how = solve::options_of(diagram.run);
    how.samples = asked.whole("samples", 2, kMostSamples).value_or(how.samples);
    how.max_steps = std::min(how.max_steps, static_cast<std::int64_t>(limits_.steps));
    how.watch_overloads = diagram.machine.profile != "ideal";
    how.trust = asked.flag("trust");
    const std::vector<text::TableColumn> columns = solve::run_columns(flat, how);
    check_numbers(static_cast<std::size_t>(how.samples), columns.size(), name);
    Deadline deadline(limits_.seconds);
    how.interrupted = [&] { return deadline.passes(); };
    solve::Run done = solve::run(program, flat, how);

    if (deadline.passed())
      done.warnings.push_back({{name, {}},
                               fmt::format("the run was ended at t = {:.9g} s: it had taken {:.3g} s of time",
                                           done.state.time, limits_.seconds),
                               {},
                               "end the run earlier, or allow it more time"});
    Answer ran;
    Json& json = ran.object;
    json["columns"] = columns_of(columns);
    json["rows"] = done.trajectory.rows();
    json["time"] = done.state.time;
    json["complete"] = !deadline.passed();
    json["method"] = diagram::method_name(done.method.method);
    json["steps"] = done.statistics.steps;
    json["seconds"] = done.seconds;
    json["events"] = Json::array();
    for (const solve::EventRecord& event : done.events)
      json["events"].push_back({{"time", event.time}, {"what", event.what}});
    json["overloads"] = Json::array();
    for (const solve::OverloadRecord& overload : done.overloads) {
      json["overloads"].push_back({{"signal", program.signal_names()[overload.signal]},
                                   {"first", overload.first},
                                   {"peak", overload.peak.value}});
    }
    json["warnings"] = to_json(done.warnings);
    if (done.trust) json["trust"] = trust_of(*done.trust);
    const std::span<const double> values = done.trajectory.values();
    ran.numbers.assign(values.begin(), values.end());
    return ran;
  });
}

Answer Engine::check(const std::string& text, const std::string& name, const std::string& options) const {
  return answer([&] {
    check_size(text, name);
    const Options asked(options, {"step", "set"});
    expect_kind(text, name, FileKind::diagram, "a lesson");
    const diagram::Diagram diagram = diagram::parse_diagram(text, name);
    solve::RunOptions how = solve::options_of(diagram.run);
    how.max_steps = std::min(how.max_steps, static_cast<std::int64_t>(limits_.steps));
    Deadline deadline(limits_.seconds);
    how.interrupted = [&] { return deadline.passes(); };
    Answer held;
    held.object = checked_lesson(diagram, *library_, asked, how);
    if (deadline.passed())
      refuse_file(name, fmt::format("the run had taken {:.3g} s of time before its end", limits_.seconds), {},
                  "turn back what makes it slow, or allow it more time");
    return held;
  });
}

Answer Engine::patch(const std::string& text, const std::string& name, const std::string& options) const {
  return answer([&] {
    check_size(text, name);
    const Options asked(options, {"gain", "bandwidth", "slower", "method", "split", "force", "period"});
    expect_kind(text, name, FileKind::mechanism, "a patch");
    patch::PatchOptions how = patch_options(asked);
    how.force = asked.flag("force");
    const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, name);
    const commission::JudgedPatch patched = commission::judged_patch(mechanism, *library_, how);
    std::string judgement = report::judgement_text(patched.judgement);
    if (const auto drive = compare::drive_off_branch(mechanism, patched, *library_))
      judgement += report::left_branch_text(mechanism, *drive);
    Answer made;
    made.object["text"] = diagram::write_diagram(patched.diagram);
    made.object["judgement"] = judgement;
    made.object["split"] = patched.options.split;
    if (patched.options.slower) made.object["slower"] = *patched.options.slower;
    return made;
  });
}

Answer Engine::motion(const std::string& text, const std::string& name, const std::string& options) const {
  return answer([&] {
    check_size(text, name);
    constexpr int kMostPositions = 10'000'000;
    const Options asked(options, {"positions", "until", "at_limit"});
    expect_kind(text, name, FileKind::mechanism, "a motion");
    mechanism::MotionOptions how;
    how.positions = asked.whole("positions", 2, kMostPositions).value_or(how.positions);
    how.until = asked.quantity("until", "s");
    if (how.until && !(*how.until > 0 && std::isfinite(*how.until)))
      refuse_file({}, fmt::format("'until' is {}", *how.until), "a finite time above 0");
    if (const auto at_limit = asked.word("at_limit")) {
      how.at_limit = mechanism::parse_at_limit(*at_limit);
      if (!how.at_limit)
        refuse_file({}, fmt::format("'at_limit' is '{}'", *at_limit), "open, stop or reverse");
    }
    const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, name);
    if (mechanism.drives.empty())
      mechanism::period(mechanism);  // says so, where `decompose` would speak of its mobility
    const mechanism::Structure structure = mechanism::decompose(mechanism);
    const std::vector<text::TableColumn> columns = report::motion_table_columns(mechanism);
    check_numbers(static_cast<std::size_t>(how.positions), columns.size(), name);

    Answer moved;
    std::vector<double> values(columns.size());
    const auto events =
        mechanism::visit_motion(mechanism, structure, how, [&](const mechanism::MotionRow& row) {
          mechanism::motion_values(mechanism, row, values);
          values.back() = static_cast<double>(row.configuration.status);
          moved.numbers.insert(moved.numbers.end(), values.begin(), values.end());
        });
    Json& json = moved.object;
    json["columns"] = columns_of(columns);
    json["rows"] = moved.numbers.size() / columns.size();
    json["statuses"] = columns.back().labels;
    json["events"] = Json::array();
    for (const mechanism::MotionEvent& event : events) {
      json["events"].push_back({{"time", event.time},
                                {"kind", event_name(event.kind)},
                                {"group", structure.groups[event.group].name}});
    }
    return moved;
  });
}

Answer Engine::draw(const std::string& text, const std::string& name, const std::string& options) const {
  return answer([&] {
    check_size(text, name);
    return Answer{drawn(text, name, *library_, options), {}};
  });
}

Answer Engine::blocks() const {
  return answer([&] { return Answer{catalogue(*library_), {}}; });
}

Answer Engine::panel(const std::string& text, const std::string& name, const std::string& options) const {
  return answer([&] {
    check_size(text, name);
    expect_kind(text, name, FileKind::diagram, "a patch panel");
    return Answer{panel_of(text, name, *library_, Options(options, {"theme", "held", "data"})), {}};
  });
}

Answer Engine::inside(const std::string& text, const std::string& name, const std::string& options) const {
  return answer([&] {
    check_size(text, name);
    expect_kind(text, name, FileKind::diagram, "a patch panel");
    return Answer{inside_of(text, name, *library_, Options(options, {"theme", "path", "data"})), {}};
  });
}

Answer Engine::edit(const std::string& text, const std::string& name, const std::string& options) const {
  return answer([&] {
    check_size(text, name);
    expect_kind(text, name, FileKind::diagram, "patching");
    return Answer{edited(text, name, *library_, options), {}};
  });
}

void Engine::check_size(const std::string& text, const std::string& name) const {
  if (static_cast<double>(text.size()) <= limits_.text) return;
  refuse_file(name, fmt::format("the file has {} bytes", text.size()),
              fmt::format("{} at most", limits_.text));
}

void Engine::check_numbers(std::size_t rows, std::size_t columns, const std::string& name) const {
  const double numbers = static_cast<double>(rows) * static_cast<double>(columns);
  if (numbers <= limits_.numbers) return;
  refuse_file(name, fmt::format("{} rows of {} columns are too much for a page", rows, columns),
              fmt::format("{} numbers at most", limits_.numbers), "ask for fewer rows");
}

}  // namespace oblique::studio
