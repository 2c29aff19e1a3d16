// SPDX-License-Identifier: MIT
#include <oblique/ensemble/plan/plan_file.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include <oblique/text/file.h>
#include <oblique/text/table_reader.h>
#include <oblique/text/toml_text.h>

namespace oblique::ensemble {
namespace {

/// The largest whole number that a double holds and no other one rounds to.
constexpr double kLargestWhole = 9'007'199'254'740'991.0;
/// As a diagram's own rows.
constexpr double kMostSamples = 1e7;
/// A factor of two is no tolerance any more.
constexpr double kMostTolerance = 0.5;

struct SamplingName {
  Sampling sampling;
  std::string_view name;
};
constexpr std::array<SamplingName, 3> kSamplings{
    {{Sampling::grid, "grid"}, {Sampling::latin_hypercube, "latin-hypercube"}, {Sampling::sobol, "sobol"}}};

/// What of [scatter] is no parameter of a type of blocks.
constexpr const char* kTolerance = "tolerance";
constexpr const char* kMachine = "machine";

class PlanReader {
 public:
  PlanReader(const text::Document& document, PlanFile& file)
      : reader_(document.file, document.root, "the plan", diagnostics_), file_(file), plan_(file.plan) {}

  void read() {
    if (!text::check_format(reader_, "oblique-ensemble/1")) diagnostics_.throw_if_any<PlanError>();
    file_.title = reader_.string("title").value_or("");
    file_.version = reader_.string("version").value_or("");
    read_subject();
    if (const auto runs = whole("runs", 1, kLargestWhole)) plan_.runs = static_cast<std::uint64_t>(*runs);
    read_seed();
    read_sampling();
    if (const auto samples = whole("samples", 2, kMostSamples)) plan_.samples = static_cast<int>(*samples);
    read_tolerance();
    if (const text::Value* const table = reader_.table("vary")) read_variations(*table);
    if (const text::Value* const table = reader_.table("scatter")) read_scatter(*table);
    read_measures();
    if (plan_.vary.empty() && plan_.scatter.empty() && !(plan_.tolerance_of_elements > 0) &&
        plan_.machine.empty() && reader_.table().find("vary") == nullptr &&
        reader_.table().find("scatter") == nullptr)
      report("", "nothing varies in this plan: it has neither [vary] nor [scatter]",
             R"([vary] with lines such as "c.gain" = "1e2..1e6:41:log")");
    reader_.finish();
    diagnostics_.throw_if_any<PlanError>();
  }

 private:
  void report(std::string_view key, std::string what, std::string expected, text::Remedy remedy = {}) {
    reader_.report(key, std::move(what), std::move(expected), std::move(remedy));
  }

  void read_subject() {
    const auto diagram = path("diagram"), mechanism = path("mechanism");
    if (diagram && mechanism) {
      report("mechanism", "the plan names a diagram and a mechanism", "one of the two");
    } else if (diagram || mechanism) {
      plan_.subject = diagram ? *diagram : *mechanism;
      plan_.mechanism = mechanism.has_value();
    } else if (reader_.table().find("diagram") == nullptr && reader_.table().find("mechanism") == nullptr) {
      report("", "the plan says not what is run", R"(diagram = "FILE.toml" or mechanism = "FILE.toml")");
    }
    if (const auto gain = reader_.quantity("gain", "1")) {
      if (!(*gain > 0 && std::isfinite(*gain)))
        report("gain", fmt::format("'gain' of the plan is {}", *gain), "a finite number above 0");
      plan_.gain = *gain;
    }
    plan_.method = reader_.string("method");
    if (!diagram) return;
    for (const char* key : {"gain", "method"}) {
      if (reader_.table().find(key) != nullptr)
        report(key,
               fmt::format("'{}' is for mechanisms, which are patched, and this plan has a diagram", key), {},
               "leave it out; [vary] sets parameters of blocks");
    }
  }

  /// A path, from the folder that the plan is in.
  std::optional<std::string> path(std::string_view key) {
    const auto name = reader_.string(key);
    if (!name) return std::nullopt;
    if (name->empty() || name->find('\0') != std::string::npos) {
      report(key, fmt::format("'{}' of the plan names no file", key), "the path of a file");
      return std::nullopt;
    }
    return (std::filesystem::path(plan_.file).parent_path() / *name).lexically_normal().string();
  }

  std::optional<double> whole(std::string_view key, double least, double most) {
    const auto number = reader_.quantity(key, "1");
    if (!number) return std::nullopt;
    if (*number >= least && *number <= most && *number == std::floor(*number)) return number;
    report(key, fmt::format("'{}' of the plan is {}", key, *number),
           fmt::format("a whole number from {} to {:.0f}", least, most));
    return std::nullopt;
  }

  /// A seed has 64 bits: those that TOML's numbers here do not hold stand as a text.
  void read_seed() {
    const text::Value* const value = reader_.find("seed");
    if (value == nullptr) return;
    if (value->kind == text::Value::Kind::string) {
      const char* const end = value->text.data() + value->text.size();
      const auto read = std::from_chars(value->text.data(), end, plan_.seed);
      if (read.ec == std::errc() && read.ptr == end && !value->text.empty()) return;
    } else if (value->kind == text::Value::Kind::number && value->number >= 0 &&
               value->number <= kLargestWhole && value->number == std::floor(value->number)) {
      plan_.seed = static_cast<std::uint64_t>(value->number);
      return;
    }
    report("seed", "'seed' of the plan is no whole number that can be told from its neighbours",
           fmt::format("a whole number from 0 to {:.0f}, or up to {} as a text", kLargestWhole,
                       std::numeric_limits<std::uint64_t>::max()));
  }

  void read_sampling() {
    const auto name = reader_.string("sampling");
    if (!name) return;
    std::vector<std::string> names;
    for (const SamplingName& known : kSamplings) {
      names.emplace_back(known.name);
      if (*name == known.name) {
        plan_.sampling = known.sampling;
        return;
      }
    }
    report("sampling", fmt::format("there is no sampling '{}'", *name), {}, text::suggest(*name, names));
  }

  void read_tolerance() {
    const auto tolerance = reader_.quantity("tolerance", "1");
    if (!tolerance) return;
    if (!(*tolerance > 0 && *tolerance < 1))
      report("tolerance", fmt::format("'tolerance' of the plan is {}", *tolerance),
             "a number above 0 and below 1, such as 1e-8",
             "that of the elements is 'tolerance' in [scatter]");
    plan_.tolerance = *tolerance;
  }

  /// A value as it would stand in a list of the command line.
  static std::optional<std::string> one_value(const text::Value& value) {
    if (value.kind == text::Value::Kind::number) return fmt::format("{}", value.number);
    if (value.kind == text::Value::Kind::string) return value.text;
    return std::nullopt;
  }

  void read_variations(const text::Value& table) {
    if (table.entries.empty())
      diagnostics_.add({reader_.place(table.position),
                        "[vary] names nothing",
                        R"(lines such as "c.gain" = "1e2..1e6:41:log")",
                        {}});
    for (const text::Entry& entry : table.entries) {
      Variation variation{entry.key, {}, reader_.place(entry.value.position)};
      bool good = true;
      if (const auto one = one_value(entry.value)) {
        variation.values = *one;
      } else if (entry.value.kind == text::Value::Kind::array && !entry.value.elements.empty()) {
        for (const text::Value& element : entry.value.elements) {
          const auto text = one_value(element);
          good = good && text;
          if (!variation.values.empty()) variation.values += ",";
          variation.values += text.value_or("");
        }
      } else {
        good = false;
      }
      if (!good)
        diagnostics_.add({variation.place,
                          fmt::format("'{}' in [vary] is {}, which gives no values", entry.key,
                                      text::kind_name(entry.value.kind)),
                          R"(a list of numbers, "FROM..TO:STEPS" or "FROM..TO:STEPS:log")",
                          dotted(entry.value) ? R"(put the name in quotes: "c.gain" = …)" : ""});
      plan_.vary.push_back(std::move(variation));
    }
  }

  /// c.gain without quotes is a table of TOML.
  static bool dotted(const text::Value& value) { return value.kind == text::Value::Kind::table; }

  void read_scatter(const text::Value& table) {
    text::TableReader reader(plan_.file, table, "[scatter]", diagnostics_);
    if (table.entries.empty())
      diagnostics_.add({reader.place(table.position),
                        "[scatter] names nothing",
                        R"(lines such as "multiplier.error" = "0.1%", or tolerance = "0.1%")",
                        {}});
    if (const auto tolerance = reader.quantity(kTolerance, "1")) {
      if (!(*tolerance > 0 && *tolerance <= kMostTolerance))
        reader.report(kTolerance, fmt::format("'tolerance' of [scatter] is {}", *tolerance),
                      "a number above 0 and up to 50%");
      plan_.tolerance_of_elements = *tolerance;
    }
    plan_.machine = reader.string(kMachine).value_or("");
    for (const text::Entry& entry : table.entries) {
      if (entry.key == kTolerance || entry.key == kMachine) continue;
      reader.find(entry.key);
      const std::size_t dot = entry.key.rfind('.');
      if (dot == std::string::npos || dot == 0 || dot + 1 == entry.key.size()) {
        diagnostics_.add({reader.place(entry.position),
                          fmt::format("'{}' in [scatter] names no parameter of a type of blocks", entry.key),
                          R"("TYPE.PARAMETER", such as "multiplier.error", or tolerance, or machine)",
                          dotted(entry.value)
                              ? text::Remedy("put the name in quotes: \"multiplier.error\" = …")
                              : text::Remedy(nearest(entry.key))});
        continue;
      }
      const auto width = text::read_quantity(plan_.file, entry.value, "1",
                                             fmt::format("'{}' in [scatter]", entry.key), diagnostics_);
      if (!width) continue;
      if (!(*width > 0 && std::isfinite(*width)))
        diagnostics_.add({reader.place(entry.value.position),
                          fmt::format("'{}' in [scatter] is {}", entry.key, *width),
                          "half the width of the scatter, a finite number above 0",
                          {}});
      plan_.scatter.push_back({entry.key.substr(0, dot), entry.key.substr(dot + 1), *width,
                               reader.place(entry.value.position),
                               entry.value.text.find('%') != std::string::npos});
    }
  }

  static std::string nearest(const std::string& key) {
    const auto found = text::nearest_name(key, {kTolerance, kMachine});
    return found ? fmt::format("did you mean '{}'?", *found) : "";
  }

  /// Without any the end of each output is measured.
  void read_measures() {
    const text::Value* const table = reader_.table("measure");
    if (table == nullptr) return;
    if (table->entries.empty())
      report("measure", "[measure] names nothing", R"toml(lines such as largest = "max(abs(x))")toml");
    for (const text::Entry& entry : table->entries) {
      if (entry.value.kind != text::Value::Kind::string) {
        diagnostics_.add(
            {reader_.place(entry.value.position),
             fmt::format("'{}' in [measure] is {}", entry.key, text::kind_name(entry.value.kind)),
             R"toml(an expression over the run in quotes, such as "max(abs(x))")toml",
             {}});
        continue;
      }
      plan_.measures.push_back({entry.key, entry.value.text, reader_.place(entry.value.position)});
    }
  }

  text::Diagnostics diagnostics_;
  text::TableReader reader_;
  PlanFile& file_;
  Plan& plan_;
};

/// A number so that it reads back to the same bits.
std::string number_text(double value) {
  return fmt::format("{}", value);
}

void write_line(std::string& out, std::string_view key, const std::string& value) {
  out += fmt::format("{} = {}\n", text::toml_key(key), value);
}

/// As it is read from the folder of `file`.
std::string subject_text(const std::string& subject, const std::filesystem::path& file) {
  const std::filesystem::path path = subject;
  if (path.is_absolute()) return path.string();
  const std::filesystem::path folder = file.parent_path();
  if (folder.empty()) return path.lexically_normal().string();
  const std::filesystem::path from = std::filesystem::absolute(folder).lexically_normal();
  return std::filesystem::absolute(path).lexically_normal().lexically_relative(from).string();
}

}  // namespace

std::string_view sampling_name(Sampling sampling) {
  for (const SamplingName& known : kSamplings) {
    if (known.sampling == sampling) return known.name;
  }
  return kSamplings.front().name;
}

PlanFile parse_plan(std::string_view text, std::string file) {
  PlanFile plan;
  plan.plan.file = std::move(file);
  PlanReader(text::parse_document(text, plan.plan.file), plan).read();
  return plan;
}

PlanFile read_plan(const std::filesystem::path& path) {
  return parse_plan(text::read_file(path), path.string());
}

std::string write_plan(const PlanFile& file, const std::filesystem::path& path) {
  const Plan& plan = file.plan;
  std::string out = "format = \"oblique-ensemble/1\"\n";
  if (!file.title.empty()) write_line(out, "title", text::toml_string(file.title));
  if (!file.version.empty()) write_line(out, "version", text::toml_string(file.version));
  write_line(out, plan.mechanism ? "mechanism" : "diagram",
             text::toml_string(subject_text(plan.subject, path)));
  if (plan.runs) write_line(out, "runs", std::to_string(*plan.runs));
  const bool fits = plan.seed <= static_cast<std::uint64_t>(kLargestWhole);
  write_line(out, "seed", fits ? std::to_string(plan.seed) : text::toml_string(std::to_string(plan.seed)));
  write_line(out, "sampling", text::toml_string(sampling_name(plan.sampling)));
  if (plan.samples) write_line(out, "samples", std::to_string(*plan.samples));
  if (plan.tolerance) write_line(out, "tolerance", number_text(*plan.tolerance));
  if (plan.gain) write_line(out, "gain", number_text(*plan.gain));
  if (plan.method) write_line(out, "method", text::toml_string(*plan.method));
  if (!plan.vary.empty()) {
    out += "\n[vary]\n";
    for (const Variation& one : plan.vary) write_line(out, one.name, text::toml_string(one.values));
  }
  if (!plan.scatter.empty() || plan.tolerance_of_elements > 0 || !plan.machine.empty()) {
    out += "\n[scatter]\n";
    if (plan.tolerance_of_elements > 0) write_line(out, kTolerance, number_text(plan.tolerance_of_elements));
    if (!plan.machine.empty()) write_line(out, kMachine, text::toml_string(plan.machine));
    for (const Scattered& one : plan.scatter)
      write_line(out, one.block + "." + one.parameter, number_text(one.half_width));
  }
  if (!plan.measures.empty()) out += "\n[measure]\n";
  for (const Measure& one : plan.measures) write_line(out, one.name, text::toml_string(one.expression));
  return out;
}

}  // namespace oblique::ensemble
