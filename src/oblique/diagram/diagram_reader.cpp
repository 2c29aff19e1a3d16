// SPDX-License-Identifier: MIT
#include <oblique/diagram/diagram_reader.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include <oblique/diagram/expectations.h>
#include <oblique/diagram/layout_reader.h>
#include <oblique/diagram/lesson.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/diagram/names.h>
#include <oblique/diagram/published.h>
#include <oblique/diagram/timeline.h>
#include <oblique/text/file.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram {
namespace {

/// The largest whole number that a run setting takes; a double holds it exactly.
constexpr double kLargestWhole = 1e15;

/// Rows of a trajectory that fit into memory with some hundred columns.
constexpr double kMostSamples = 1e7;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class DiagramReader {
 public:
  DiagramReader(const text::Document& document, Diagram& diagram, text::Diagnostics& diagnostics)
      : diagnostics_(diagnostics),
        reader_(document.file, document.root, "the diagram", diagnostics_),
        diagram_(diagram) {}

  void read() {
    if (!text::check_format(reader_, "oblique-diagram/1")) diagnostics_.throw_if_any<DiagramError>();
    diagram_.title = reader_.string("title").value_or("");
    diagram_.source = reader_.string("source").value_or("");
    if (const text::Value* const table = reader_.table("machine")) read_machine(*table);
    if (const text::Value* const table = reader_.table("groups"))
      diagram_.groups = read_groups(diagram_.file, *table, diagnostics_);
    if (const text::Value* const table = reader_.table("timeline")) {
      diagram_.timeline =
          read_timeline(diagram_.file, *table, diagram_.groups, diagram_.machine.profile, diagnostics_);
      const double whole = duration_of(diagram_.timeline);
      if (whole > 0 && std::isfinite(whole)) diagram_.run.until = last_time_ = whole;
    }
    if (const text::Value* const table = reader_.table("run")) read_run(*table);
    if (const text::Value* const table = reader_.table("blocks")) {
      diagram_.blocks = read_blocks(diagram_.file, *table, diagnostics_);
    } else if (reader_.table().find("blocks") == nullptr) {
      reader_.report("blocks", "the diagram has no [blocks]", "at least one block");
    }
    if (const text::Value* const table = reader_.table("outputs")) read_outputs(*table);
    if (const text::Value* const table = reader_.table("expect")) {
      diagram_.expectations = read_expectations(diagram_, *table, "[expect]", last_time_, diagnostics_);
    }
    if (const text::Value* const table = reader_.table("published"))
      diagram_.published = read_published(diagram_, *table, last_time_, diagnostics_);
    if (const text::Value* const table = reader_.table("lesson"))
      diagram_.lesson = read_lesson(diagram_, *table, last_time_, diagnostics_);
    if (!diagram_.outputs.empty()) {
      std::vector<std::string> names;
      for (const OutputSpec& output : diagram_.outputs) names.push_back(output.name);
      check_expected_outputs(diagram_, names, diagnostics_);
    }
    if (const text::Value* const table = reader_.table("layout"))
      diagram_.layout = read_layout(diagram_.file, *table, diagram_.blocks, diagnostics_);
    reader_.finish();
  }

 private:
  void read_machine(const text::Value& table) {
    text::TableReader reader(diagram_.file, table, "[machine]", diagnostics_);
    MachineSettings& machine = diagram_.machine;
    machine.profile = reader.string("profile").value_or(machine.profile);
    const MachineProfile* const profile = find_machine(machine.profile);
    if (profile == nullptr)
      diagnostics_.add(unknown_machine(machine.profile, reader.place(table.find("profile")->position)));
    machine.inverting = reader.boolean("inverting").value_or(profile != nullptr && profile->inverting);
    reader.finish();
  }

  void read_method(text::TableReader& reader) {
    const auto name = reader.string("method");
    if (!name) return;
    std::vector<std::string> names;
    for (const IntegrationMethod method : kIntegrationMethods) {
      names.emplace_back(method_name(method));
      if (*name == names.back()) {
        diagram_.run.method = method;
        return;
      }
    }
    reader.report("method", fmt::format("there is no method '{}'", *name), {}, text::suggest(*name, names));
  }

  void read_run(const text::Value& table) {
    text::TableReader reader(diagram_.file, table, "[run]", diagnostics_);
    RunSettings& run = diagram_.run;
    if (const auto until = reader.quantity("until", "s")) {
      if (*until > 0 && std::isfinite(*until)) {
        run.until = last_time_ = *until;
      } else {
        last_time_ = kInfinity;
        reader.report("until", fmt::format("'until' of [run] is {} s", *until), "a finite time above 0 [s]");
      }
    }
    if (const auto tolerance = reader.quantity("tolerance", "1")) {
      if (*tolerance > 0 && *tolerance < 1) {
        run.tolerance = *tolerance;
      } else {
        reader.report("tolerance", fmt::format("'tolerance' of [run] is {}", *tolerance),
                      "a number above 0 and below 1, such as 1e-8");
      }
    }
    run.absolute_tolerance = above_zero(reader, "absolute_tolerance", "machine unit");
    run.max_step = above_zero(reader, "max_step", "s");
    read_method(reader);
    if (const text::Value* const own = reader.table("tolerances")) {
      for (const text::Entry& entry : own->entries) {
        const std::string subject = fmt::format("tolerance of '{}' in [run]", entry.key);
        const auto number =
            text::read_quantity(diagram_.file, entry.value, unit_on(diagram_.machine.profile, "machine unit"),
                                subject, diagnostics_);
        if (!number) continue;
        if (!(*number > 0 && std::isfinite(*number))) {
          diagnostics_.add({{diagram_.file, entry.value.position},
                            fmt::format("{} is {}", subject, *number),
                            "a finite number above 0 [machine unit]",
                            {}});
        }
        run.tolerances.emplace_back(entry.key, *number);
      }
    }
    run.samples = static_cast<int>(whole(reader, "samples", 2, kMostSamples).value_or(run.samples));
    run.max_steps = whole(reader, "max_steps", 1, kLargestWhole).value_or(run.max_steps);
    run.settle = reader.boolean("settle").value_or(true);
    reader.finish();
  }

  static std::optional<double> above_zero(text::TableReader& reader, std::string_view key,
                                          std::string_view unit) {
    const auto number = reader.quantity(key, unit);
    if (!number || (*number > 0 && std::isfinite(*number))) return number;
    reader.report(key, fmt::format("'{}' of [run] is {} {}", key, *number, unit),
                  fmt::format("a finite number above 0 [{}]", unit));
    return std::nullopt;
  }

  static std::optional<std::int64_t> whole(text::TableReader& reader, std::string_view key, double least,
                                           double most) {
    const auto number = reader.quantity(key, "1");
    if (!number) return std::nullopt;
    if (*number >= least && *number <= most && *number == std::floor(*number))
      return static_cast<std::int64_t>(*number);
    reader.report(key, fmt::format("'{}' of [run] is {}", key, *number),
                  fmt::format("a whole number from {} to {}", least, most));
    return std::nullopt;
  }

  void read_outputs(const text::Value& table) {
    for (const text::Entry& entry : table.entries) {
      OutputSpec output;
      output.name = entry.key;
      output.place = {diagram_.file, entry.value.position};
      if (entry.value.kind == text::Value::Kind::string) {
        output.signal = entry.value.text;
      } else if (entry.value.kind == text::Value::Kind::table) {
        read_output(entry, output);
      } else {
        diagnostics_.add({output.place,
                          fmt::format("output '{}' is {}", entry.key, text::kind_name(entry.value.kind)),
                          R"("signal" or { signal = "…", scale = 1, unit = "…" })",
                          {}});
      }
      diagram_.outputs.push_back(std::move(output));
    }
  }

  void read_output(const text::Entry& entry, OutputSpec& output) {
    text::TableReader reader(diagram_.file, entry.value, fmt::format("output '{}'", entry.key), diagnostics_);
    output.signal = reader.required_string("signal", "the name of a signal").value_or("");
    if (const text::Value* const signal = entry.value.find("signal"))
      output.place.position = signal->position;
    output.unit = reader.string("unit").value_or(output.unit);
    output.scale = reader.quantity("scale", "1").value_or(of_machine_unit(output.unit));
    if (!std::isfinite(output.scale)) {
      reader.report("scale", fmt::format("'scale' of output '{}' is infinite", entry.key), "a finite number");
    }
    output.offset = reader.quantity("offset", "1").value_or(0);
    if (!std::isfinite(output.offset)) {
      reader.report("offset", fmt::format("'offset' of output '{}' is infinite", entry.key),
                    "a finite number");
    }
    reader.finish();
  }

  /// What a machine unit is in a unit of an output that gives no scale: its volts, where those are asked for
  /// and known, else 1.
  double of_machine_unit(const std::string& of_output) const {
    const auto unit = text::parse_unit(of_output);
    const text::Unit volt = unit_on(diagram_.machine.profile, "V");
    return unit && unit->same_dimension(volt) && volt.volts ? *volt.volts / unit->scale : 1;
  }

  text::Diagnostics& diagnostics_;
  text::TableReader reader_;
  Diagram& diagram_;
  double last_time_ = RunSettings{}.until;  ///< of expectations; infinite where `until` is wrong
};

}  // namespace

Diagram parse_diagram(std::string_view text, std::string file, text::Diagnostics& diagnostics) {
  Diagram diagram;
  diagram.file = std::move(file);
  DiagramReader(text::parse_document(text, diagram.file), diagram, diagnostics).read();
  return diagram;
}

Diagram parse_diagram(std::string_view text, std::string file) {
  text::Diagnostics diagnostics;
  Diagram diagram = parse_diagram(text, std::move(file), diagnostics);
  diagnostics.throw_if_any<DiagramError>();
  return diagram;
}

Diagram read_diagram(const std::filesystem::path& path) {
  return parse_diagram(text::read_file(path), path.string());
}

}  // namespace oblique::diagram
