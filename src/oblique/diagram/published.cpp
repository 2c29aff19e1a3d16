// SPDX-License-Identifier: MIT
#include <oblique/diagram/published.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <oblique/diagram/expectations.h>
#include <oblique/text/toml_text.h>

namespace oblique::diagram {
namespace {

constexpr std::string_view kProgramme = "programme", kEquations = "equations";
constexpr std::string_view kMaximumWord = "maximum", kMinimumWord = "minimum", kEndWord = "end",
                           kPeriodWord = "period";

/// Before it there were no analog computers, and after it no prints.
constexpr double kFirstYear = 1800, kLastYear = 2199;

/// The texts of `[published]` by their keys, in the order in which they are cited.
struct TextKey {
  std::string_view key;
  std::string Published::*member;
};
constexpr std::array<TextKey, 9> kTextKeys{{{"author", &Published::author},
                                            {"title", &Published::title},
                                            {"in", &Published::in},
                                            {"number", &Published::number},
                                            {"page", &Published::page},
                                            {"address", &Published::address},
                                            {"machine", &Published::machine},
                                            {"subject", &Published::subject},
                                            {"picture", &Published::picture}}};

class PublishedReader {
 public:
  PublishedReader(const Diagram& diagram, const text::Value& table, double until,
                  text::Diagnostics& diagnostics)
      : diagram_(diagram),
        until_(until),
        diagnostics_(diagnostics),
        reader_(diagram.file, table, "[published]", diagnostics) {
    published_.place = {diagram.file, table.position};
  }

  Published read() {
    read_kind();
    for (const auto& [key, member] : kTextKeys) {
      const bool may_be_number = key == "number" || key == "page";
      published_.*member = may_be_number ? text_or_whole(key) : reader_.string(key).value_or("");
    }
    published_.leads = reader_.boolean("leads").value_or(false);
    for (const std::string_view key : {"author", "title"}) {
      if (reader_.table().find(key) == nullptr)
        reader_.report(key, fmt::format("[published] has no '{}'", key), "a text");
    }
    read_year();
    if (const auto names = reader_.strings("plot")) read_plot(*names);
    published_.errata = reader_.strings("errata", true).value_or(std::vector<std::string>{});
    read_values();
    reader_.finish();
    return std::move(published_);
  }

 private:
  void read_kind() {
    const auto kind = reader_.string("kind");
    if (!kind || *kind == kProgramme) return;
    published_.kind = Published::Kind::equations;
    if (*kind == kEquations) return;
    reader_.report("kind", fmt::format("'kind' of [published] is '{}'", *kind),
                   R"("programme", a circuit as it was patched, or "equations", composed here)",
                   text::suggest(*kind, {std::string(kProgramme), std::string(kEquations)}));
  }

  /// A text; a whole number from 0 on stands for itself, as the number of an issue.
  std::string text_or_whole(std::string_view key) {
    const text::Value* const value = reader_.find(key);
    if (value == nullptr) return {};
    if (value->kind == text::Value::Kind::string) return value->text;
    if (value->kind == text::Value::Kind::number && value->number == std::floor(value->number) &&
        value->number >= 0 && value->number < 1e15)
      return fmt::format("{:.0f}", value->number);
    const bool is_number = value->kind == text::Value::Kind::number;
    reader_.report(key,
                   fmt::format("'{}' of [published] is {}", key,
                               is_number ? fmt::format("{}", value->number) : text::kind_name(value->kind)),
                   "a text, or a whole number from 0 on");
    return {};
  }

  void read_year() {
    const auto year = reader_.quantity("year", "1");
    if (!year) return;
    if (*year == std::floor(*year) && *year >= kFirstYear && *year <= kLastYear) {
      published_.year = static_cast<int>(*year);
    } else {
      reader_.report("year", fmt::format("'year' of [published] is {}", *year),
                     fmt::format("a whole number from {} to {}", kFirstYear, kLastYear));
    }
  }

  void read_plot(const std::vector<std::string>& names) {
    published_.plot = names;
    if (names.size() < 2) {
      reader_.report("plot",
                     fmt::format("'plot' of [published] names {}", names.empty() ? "nothing" : "one output"),
                     R"(["y", "x"]: y against x, the last along the horizontal axis)");
    }
    for (auto name = names.begin(); name != names.end(); ++name) {
      if (std::find(names.begin(), name, *name) == name) continue;
      reader_.report("plot", fmt::format("'plot' of [published] names '{}' twice", *name),
                     "each output once, and the last along the horizontal axis");
      return;
    }
  }

  void read_values() {
    const text::Value* const list = reader_.find("value");
    const bool held = list != nullptr || !published_.picture.empty();
    if (published_.kind == Published::Kind::programme && !held) {
      reader_.report("value", "[published] gives nothing to hold the run against",
                     "[[published.value]] or 'picture', what a published picture shows",
                     R"(where only equations were published, say kind = "equations")");
    }
    if (list == nullptr) return;
    if (list->kind != text::Value::Kind::array) {
      reader_.report("value", fmt::format("'value' of [published] is {}", text::kind_name(list->kind)),
                     "tables [[published.value]]");
      return;
    }
    for (const text::Value& element : list->elements) read_value(element);
  }

  void read_value(const text::Value& table) {
    PublishedValue value;
    Expectation& expected = value.expected;
    expected.place = {diagram_.file, table.position};
    text::TableReader reader(diagram_.file, table, "[[published.value]]", diagnostics_);
    const auto name = reader.required_string("name", "an output");
    expected.output = name.value_or("");
    value.label = reader.string("label").value_or("");
    value.because = reader.string("because").value_or("");
    value.tried = reader.string("tried").value_or("");
    if (!value.because.empty() && !value.tried.empty())
      reader.report("tried", "[[published.value]] has 'because' and 'tried'",
                    "the one where the difference is explained, the other where it is not");
    const bool good_time = read_at(reader, expected);
    const auto unit = read_unit(reader, value);
    if (const text::Value* const set = reader.table("set"))
      value.set = read_settings(diagram_.file, *set, "'set' of [[published.value]]", diagnostics_);
    const auto read = text::read_expected_value(reader, unit.value_or(text::Unit{}));
    if (!name || !good_time || !unit || !read) return;
    expected.value = read->value;
    expected.within = read->within;
    published_.values.push_back(std::move(value));
  }

  /// When: a time, "maximum", "minimum", "period", or "end", which is meant where nothing is said.
  bool read_at(text::TableReader& reader, Expectation& expected) {
    const text::Value* const at = reader.find("at");
    const bool is_text = at != nullptr && at->kind == text::Value::Kind::string;
    for (const auto& [word, kind] : {std::pair{kMaximumWord, Expectation::Kind::maximum},
                                     std::pair{kMinimumWord, Expectation::Kind::minimum},
                                     std::pair{kPeriodWord, Expectation::Kind::period}}) {
      if (!is_text || at->text != word) continue;
      expected.kind = kind;
      expected.text = expectation_key(expected);
      return true;
    }
    if (at == nullptr || (is_text && at->text == kEndWord)) {
      expected.time = until_;
      expected.text = fmt::format("{} at {}", expected.output, kEndWord);
      return true;
    }
    const auto time = read_expected_time(diagram_.file, *at, {diagram_.file, at->position},
                                         "'at' of [[published.value]]", until_, diagnostics_);
    if (!time) return false;
    expected.time = *time;
    expected.text = is_text ? fmt::format("{} at {}", expected.output, at->text) : expectation_key(expected);
    return true;
  }

  /// The unit of `value` and `within`, and its factor; any text may stand for a unit if the output has it
  /// too.
  std::optional<text::Unit> read_unit(text::TableReader& reader, PublishedValue& value) {
    const text::Unit own = unit_of(diagram_, value.expected);
    const bool is_time = value.expected.kind == Expectation::Kind::period;
    const auto unit = reader.string("unit");
    if (!unit && is_time) value.unit = "s";
    if (!unit) return own;
    value.unit = *unit;
    const auto output =
        std::find_if(diagram_.outputs.begin(), diagram_.outputs.end(),
                     [&](const OutputSpec& spec) { return spec.name == value.expected.output; });
    const std::string output_unit = is_time                            ? "s"
                                    : output == diagram_.outputs.end() ? OutputSpec{}.unit
                                                                       : output->unit;
    if (*unit == output_unit) return own;
    auto known = text::parse_unit(*unit);
    const bool output_known = text::parse_unit(output_unit).has_value();
    const auto factor = known && output_known ? text::factor_between(*known, own) : std::nullopt;
    if (!factor || *factor == 0) {
      reader.report(
          "unit", fmt::format("'unit' of [[published.value]] is '{}'", *unit),
          is_time ? "a unit of time"
                  : fmt::format("a unit that '{}', the unit of the output, can be given in", output_unit));
      return std::nullopt;
    }
    value.factor = *factor;
    return known;
  }

  const Diagram& diagram_;
  double until_;
  text::Diagnostics& diagnostics_;
  text::TableReader reader_;
  Published published_;
};

/// When a value is to be read, as a file says it.
std::string at_text(const Expectation& expected) {
  if (expected.kind == Expectation::Kind::maximum) return text::toml_string(kMaximumWord);
  if (expected.kind == Expectation::Kind::minimum) return text::toml_string(kMinimumWord);
  if (expected.kind == Expectation::Kind::period) return text::toml_string(kPeriodWord);
  const std::string before = expected.output + " at ";
  if (expected.text.starts_with(before)) return text::toml_string(expected.text.substr(before.size()));
  return fmt::format("{}", expected.time);
}

std::string list_text(const std::vector<std::string>& texts) {
  std::string out = "[";
  for (const std::string& text : texts) out += (out.size() > 1 ? ", " : "") + text::toml_string(text);
  return out + "]";
}

}  // namespace

Published read_published(const Diagram& diagram, const text::Value& table, double until,
                         text::Diagnostics& diagnostics) {
  return PublishedReader(diagram, table, until, diagnostics).read();
}

std::vector<ParameterOverride> read_settings(const std::string& file, const text::Value& table,
                                             const std::string& what, text::Diagnostics& diagnostics) {
  std::vector<ParameterOverride> settings;
  for (const text::Entry& entry : table.entries) {
    const text::Place place{file, entry.position};
    if (entry.value.kind == text::Value::Kind::number) {
      settings.push_back({entry.key, fmt::format("{}", entry.value.number), place});
    } else if (entry.value.kind == text::Value::Kind::string) {
      settings.push_back({entry.key, entry.value.text, place});
    } else {
      diagnostics.add({{file, entry.value.position},
                       fmt::format("'{}' in {} is {}", entry.key, what, text::kind_name(entry.value.kind)),
                       "a number or a quantity",
                       entry.value.kind == text::Value::Kind::table
                           ? text::Remedy{fmt::format("quote the whole name: \"{}.…\" = …", entry.key)}
                           : text::Remedy{}});
    }
  }
  return settings;
}

std::string settings_text(const std::vector<ParameterOverride>& settings) {
  std::string out = "{ ";
  for (const ParameterOverride& setting : settings) {
    out += (out.size() > 2 ? ", " : "") + text::toml_string(setting.path) + " = " +
           text::toml_string(setting.value);
  }
  return out + " }";
}

std::string write_published(const Published& published) {
  std::string out = "\n[published]\n";
  const auto line = [&out](std::string_view key, const std::string& value) {
    out += fmt::format("{} = {}\n", key, value);
  };
  if (published.kind == Published::Kind::equations) line("kind", text::toml_string(kEquations));
  for (const auto& [key, member] : kTextKeys) {
    const std::string& text = published.*member;
    if (!text.empty() || key == "author" || key == "title") line(key, text::toml_string(text));
    if (key == "in" && published.year) line("year", fmt::format("{}", *published.year));
  }
  if (published.leads) line("leads", "true");
  if (!published.plot.empty()) line("plot", list_text(published.plot));
  if (!published.errata.empty()) line("errata", list_text(published.errata));
  for (const PublishedValue& value : published.values) {
    out += "\n[[published.value]]\n";
    line("name", text::toml_string(value.expected.output));
    if (!value.label.empty()) line("label", text::toml_string(value.label));
    line("value", fmt::format("{}", value.expected.value));
    line("within", fmt::format("{}", value.expected.within));
    if (!value.unit.empty()) line("unit", text::toml_string(value.unit));
    line("at", at_text(value.expected));
    if (!value.set.empty()) line("set", settings_text(value.set));
    if (!value.because.empty()) line("because", text::toml_string(value.because));
    if (!value.tried.empty()) line("tried", text::toml_string(value.tried));
  }
  return out;
}

std::optional<Published> without_settings(const std::optional<Published>& published) {
  if (!published) return std::nullopt;
  Published kept = *published;
  std::erase_if(kept.values, [](const PublishedValue& value) { return !value.set.empty(); });
  if (kept.values.empty() && kept.picture.empty()) return std::nullopt;
  return kept;
}

std::string citation(const Published& published) {
  std::string text = published.author;
  const auto add = [&text](const std::string& part) {
    if (!part.empty()) text += (text.empty() ? "" : ", ") + part;
  };
  add(published.title);
  add(published.in.empty() || published.number.empty() ? published.in + published.number
                                                       : published.in + " " + published.number);
  if (published.year) add(fmt::format("{}", *published.year));
  if (!published.page.empty()) {
    const bool is_number = published.page.front() >= '0' && published.page.front() <= '9';  // not "fig. 2"
    const bool several = published.page.find_first_of("-–,") != std::string::npos;
    add((!is_number ? "" : several ? "pp. " : "p. ") + published.page);
  }
  return text;
}

std::string name_of(const PublishedValue& value) {
  if (!value.label.empty()) return value.label;
  std::string name = value.expected.text.empty() ? expectation_key(value.expected) : value.expected.text;
  for (const ParameterOverride& setting : value.set)
    name += fmt::format("{} {} = {}", &setting == &value.set.front() ? " with" : ",", setting.path,
                        setting.value);
  return name;
}

}  // namespace oblique::diagram
