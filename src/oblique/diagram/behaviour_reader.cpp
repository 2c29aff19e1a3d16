// SPDX-License-Identifier: MIT
#include <oblique/diagram/behaviour_reader.h>

#include <algorithm>

#include <fmt/format.h>

#include <oblique/diagram/block_expressions.h>
#include <oblique/diagram/names.h>
#include <oblique/text/expression_parser.h>

namespace oblique::diagram {
namespace {

class BehaviourReader {
 public:
  BehaviourReader(text::TableReader& reader, BlockDefinition& definition, text::Diagnostics& diagnostics)
      : reader_(reader),
        definition_(definition),
        diagnostics_(diagnostics),
        expressions_(definition, diagnostics) {
    for (const ParameterDefinition& parameter : definition_.parameters) {
      if (!parameter.formula) constants_.push_back(parameter.name);
    }
    constants_.emplace_back("polarity");
  }

  void read() {
    read_lets();
    read_memories();
    if (const text::Value* const cases = reader_.find("cases")) read_cases(*cases);
    read_behaviour(reader_, {}, "");
    read_starts();
    if (const text::Value* const events = reader_.find("events")) read_events(*events);
    if (const text::Value* const interval = reader_.find("check_interval")) {
      definition_.check_interval = expressions_.read(*interval, "'check_interval'");
      if (definition_.check_interval)
        expressions_.resolve(*definition_.check_interval, *interval, "'check_interval'", constants_);
    }
    if (const text::Value* const needs = reader_.table("requires")) read_needs(*needs);
    if (const text::Value* const valid = reader_.find("valid")) read_relations(*valid);
  }

 private:
  /// An equation as the file has it, with the value that its positions refer to.
  struct Written {
    Equation equation;
    const text::Value* value = nullptr;
    std::string key;
  };

  text::Place place(text::SourcePosition position) const { return {definition_.file, position}; }

  void read_needs(const text::Value& table) {
    if (definition_.role != Role::other)
      reader_.report("requires", "a block with a role has 'requires'", {},
                     "leave it out: the role says what it takes");
    for (const text::Entry& entry : table.entries) {
      const std::string what = fmt::format("'{}' of 'requires'", entry.key);
      const auto kind = read_element_kind(entry.key, place(entry.position), diagnostics_);
      auto count = expressions_.read(entry.value, what);
      if (!count || !kind) continue;
      if (expressions_.resolve(*count, entry.value, what, constants_))
        definition_.needs.push_back({*kind, std::move(*count)});
    }
  }

  void read_relations(const text::Value& list) {
    const bool texts =
        list.kind == text::Value::Kind::array &&
        std::all_of(list.elements.begin(), list.elements.end(),
                    [](const text::Value& element) { return element.kind == text::Value::Kind::string; });
    if (!texts) {
      report(list.position, "'valid' is no list of texts", R"(conditions on the parameters, ["low < high"])");
      return;
    }
    std::vector<std::string> parameters(constants_.begin(), constants_.end() - 1);  // but the polarity
    for (const text::Value& element : list.elements) {
      auto condition = expressions_.read(element, "'valid'");
      if (condition && expressions_.resolve(*condition, element, "'valid'", parameters))
        definition_.relations.push_back({std::move(*condition), element.text});
    }
    std::vector<double> defaults;
    for (const ParameterDefinition& parameter : definition_.parameters)
      defaults.push_back(parameter.default_value);
    if (const ParameterRelation* const unmet = definition_.unmet_relation(defaults))
      report(list.position, fmt::format("the defaults do not meet '{}'", unmet->text),
             "defaults with which the block works");
  }

  void report(text::SourcePosition position, std::string what, std::string expected = {},
              std::string remedy = {}) {
    diagnostics_.add({place(position), std::move(what), std::move(expected), std::move(remedy)});
  }

  void read_cases(const text::Value& cases) {
    if (cases.kind != text::Value::Kind::array) {
      report(cases.position, fmt::format("'cases' is {}", text::kind_name(cases.kind)),
             "[[cases]], an array of tables");
      return;
    }
    for (const text::Value& element : cases.elements) {
      text::TableReader reader(definition_.file, element, "[[cases]]", diagnostics_);
      if (element.kind != text::Value::Kind::table) continue;
      const text::Value* const when = reader.find("when");
      std::optional<text::Expression> condition;
      if (when == nullptr) {
        reader.report("when", "[[cases]] has no 'when'", "a condition on the parameters");
      } else {
        condition = expressions_.read(*when, "'when'");
        if (condition) expressions_.resolve(*condition, *when, "'when'", constants_);
      }
      // Without a condition the case would pass for the default; the finding above ends the reading anyway.
      read_behaviour(reader, condition ? std::move(condition) : text::Expression{},
                     when != nullptr ? fmt::format(" where {}", when->text) : " of [[cases]]");
      reader.finish();
    }
  }

  void read_behaviour(text::TableReader& reader, std::optional<text::Expression> when,
                      const std::string& which) {
    std::vector<Written> written;
    if (const text::Value* const table = reader.table("equations")) {
      for (const text::Entry& entry : table->entries) read_equation(entry, false, written);
    }
    if (const text::Value* const table = reader.table("implicit")) {
      for (const text::Entry& entry : table->entries) read_equation(entry, true, written);
    }
    check_targets(written, which);

    std::vector<std::string> names = signal_names();
    for (const Written& w : written) {
      if (std::find(names.begin(), names.end(), w.equation.target) == names.end())
        names.push_back(w.equation.target);
    }
    for (const ParameterDefinition& parameter : definition_.parameters) {
      if (parameter.formula) names.push_back(parameter.name);
    }
    Behaviour behaviour;
    behaviour.when = std::move(when);
    for (Written& w : written) {
      expressions_.resolve(w.equation.expression, *w.value, fmt::format("equation '{}'", w.key), names);
      behaviour.equations.push_back(std::move(w.equation));
    }
    definition_.behaviours.push_back(std::move(behaviour));
  }

  /// What every equation may name, apart from the targets of other equations.
  std::vector<std::string> signal_names() const {
    std::vector<std::string> names = constants_;
    for (const std::string_view engine : {"time", "in_initial", "in_operate", "in_hold"})
      names.emplace_back(engine);
    for (const InputPort& input : definition_.inputs) names.push_back(input.name);
    for (const OutputPort& output : definition_.outputs) names.push_back(output.name);
    for (const MemoryRule& memory : definition_.memories) names.push_back(memory.name);
    return names;
  }

  /// The left side of an equation without its "der()".
  static std::string_view target_of(std::string_view key) {
    return key.starts_with("der(") && key.ends_with(")") ? key.substr(4, key.size() - 5) : key;
  }

  /// What has an equation in some case: `[let]` may name it, where that case has it.
  static void add_targets(const text::Value& table, std::vector<std::string>& names) {
    for (const std::string_view key : {"equations", "implicit"}) {
      const text::Value* const equations = table.find(key);
      if (equations == nullptr) continue;
      for (const text::Entry& entry : equations->entries) {
        const std::string_view target = target_of(entry.key);
        if (std::find(names.begin(), names.end(), target) == names.end()) names.emplace_back(target);
      }
    }
  }

  void read_lets() {
    const text::Value* const table = reader_.table("let");
    if (table == nullptr) return;
    std::vector<std::string> names = signal_names();
    for (const ParameterDefinition& parameter : definition_.parameters) {
      if (parameter.formula) names.push_back(parameter.name);
    }
    if (const text::Value* const memories = reader_.table().find("memories")) {
      for (const text::Entry& entry : memories->entries) names.push_back(entry.key);
    }
    add_targets(reader_.table(), names);
    if (const text::Value* const cases = reader_.find("cases")) {
      for (const text::Value& element : cases->elements) add_targets(element, names);
    }
    expressions_.read_lets(*table, names);
  }

  void read_memories() {
    const text::Value* const table = reader_.table("memories");
    if (table == nullptr) return;
    for (const text::Entry& entry : table->entries) {
      if (!check_name(entry.key, "a memory", place(entry.position), diagnostics_)) continue;
      if (definition_.find_input(entry.key) || definition_.find_parameter(entry.key) ||
          definition_.find_output(entry.key) || expressions_.is_let(entry.key)) {
        report(entry.position, fmt::format("the name '{}' is used twice", entry.key),
               "different names for inputs, outputs, parameters, memories and [let]");
        continue;
      }
      const std::string what = fmt::format("memory '{}'", entry.key);
      auto initial = expressions_.read(entry.value, what);
      if (!initial) continue;
      expressions_.resolve(*initial, entry.value, what, constants_);
      definition_.memories.push_back({entry.key, std::move(*initial), place(entry.position)});
    }
  }

  /// A state of every case, or a memory: what an event may change.
  bool is_event_target(const std::string& name) const {
    if (definition_.find_memory(name)) return true;
    return std::all_of(
        definition_.behaviours.begin(), definition_.behaviours.end(), [&](const Behaviour& behaviour) {
          return std::any_of(behaviour.equations.begin(), behaviour.equations.end(),
                             [&](const Equation& equation) {
                               return equation.kind == Equation::Kind::derivative && equation.target == name;
                             });
        });
  }

  void read_events(const text::Value& events) {
    if (events.kind != text::Value::Kind::array) {
      report(events.position, fmt::format("'events' is {}", text::kind_name(events.kind)),
             "[[events]], an array of tables");
      return;
    }
    std::vector<std::string> names = signal_names();
    for (const Behaviour& behaviour : definition_.behaviours) {
      for (const Equation& equation : behaviour.equations) names.push_back(equation.target);
    }
    for (const text::Value& element : events.elements) {
      text::TableReader reader(definition_.file, element, "[[events]]", diagnostics_);
      if (element.kind == text::Value::Kind::table) read_event(reader, names);
    }
  }

  void read_event(text::TableReader& reader, const std::vector<std::string>& names) {
    EventRule rule;
    rule.place = place(reader.table().position);
    if (const text::Value* const when = reader.find("when")) {
      if (auto condition = expressions_.read(*when, "'when'")) {
        expressions_.resolve(*condition, *when, "'when'", names);
        rule.when = std::move(*condition);
      }
    } else {
      reader.report("when", "[[events]] has no 'when'", "the condition that starts the event");
    }
    if (const text::Value* const where = reader.find("where")) {
      rule.where = expressions_.read(*where, "'where'");
      if (rule.where) expressions_.resolve(*rule.where, *where, "'where'", constants_);
    }
    rule.at_start = reader.boolean("at_start").value_or(true);
    rule.before_start = reader.boolean("before_start").value_or(false);
    if (rule.before_start && !rule.at_start)
      reader.report("before_start", "[[events]] comes before the start, and does not come there",
                    "'at_start = false' or 'before_start = true', not both");
    const text::Value* const set = reader.table("set");
    if (set == nullptr && reader.table().find("set") == nullptr) {
      reader.report("set", "[[events]] has no 'set'", "what the event changes, { memory = \"value\" }");
    }
    if (set != nullptr) rule.actions = read_actions(*set, names);
    if (const text::Value* const piling_up = reader.table("piling_up"))
      rule.piling_up = read_actions(*piling_up, names);
    reader.finish();
    definition_.events.push_back(std::move(rule));
  }

  std::vector<EventAction> read_actions(const text::Value& set, const std::vector<std::string>& names) {
    std::vector<EventAction> actions;
    for (const text::Entry& entry : set.entries) {
      if (!is_event_target(entry.key)) {
        std::vector<std::string> known;
        for (const MemoryRule& memory : definition_.memories) known.push_back(memory.name);
        report(entry.position,
               fmt::format("'{}' is no memory and not in every case a state: no event can set it", entry.key),
               {}, text::suggest(entry.key, known));
        continue;
      }
      const std::string what = fmt::format("event's '{}'", entry.key);
      auto value = expressions_.read(entry.value, what);
      if (!value) continue;
      expressions_.resolve(*value, entry.value, what, names);
      actions.push_back({entry.key, std::move(*value), place(entry.value.position)});
    }
    return actions;
  }

  void read_equation(const text::Entry& entry, bool implicit, std::vector<Written>& written) {
    Equation equation;
    const std::string_view target = implicit ? std::string_view(entry.key) : target_of(entry.key);
    if (implicit) {
      equation.kind = Equation::Kind::implicit;
    } else if (target != entry.key) {
      equation.kind = Equation::Kind::derivative;
    }
    if (!text::is_identifier(target)) {
      report(entry.position, fmt::format("'{}' is not the left side of an equation", entry.key),
             implicit ? "the name of an unknown" : "\"name\" or \"der(name)\"");
      return;
    }
    equation.target = std::string(target);
    equation.place = place(entry.value.position);
    const bool name_is_good = check_target(equation.target, entry);
    auto expression = expressions_.read(entry.value, fmt::format("equation '{}'", entry.key));
    if (!expression || !name_is_good) {
      broken_targets_.push_back(equation.target);
      return;
    }
    equation.expression = std::move(*expression);
    written.push_back({std::move(equation), &entry.value, entry.key});
  }

  bool check_target(const std::string& target, const text::Entry& entry) {
    if (definition_.find_input(target) || definition_.find_parameter(target) ||
        definition_.find_memory(target) || expressions_.is_let(target)) {
      report(entry.position,
             fmt::format("'{}' is {} and cannot have an equation", target,
                         definition_.find_input(target)       ? "an input"
                         : definition_.find_parameter(target) ? "a parameter"
                         : definition_.find_memory(target)    ? "a memory"
                                                              : "an expression of [let]"),
             "an output or another name");
      return false;
    }
    return check_name(target, "an unknown", place(entry.position), diagnostics_);
  }

  void check_targets(const std::vector<Written>& written, const std::string& which) {
    for (std::size_t i = 0; i < written.size(); ++i) {
      const std::string& target = written[i].equation.target;
      const auto same = [&](const Written& w) { return w.equation.target == target; };
      const auto end = written.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::any_of(written.begin(), end, same)) {
        report(written[i].value->position, fmt::format("'{}' has two equations", target), "one",
               "name it once: as 'x', as 'der(x)' or in [implicit]");
      }
    }
    for (const OutputPort& output : definition_.outputs) {
      const bool found = std::any_of(written.begin(), written.end(),
                                     [&](const Written& w) { return w.equation.target == output.name; });
      const bool broken =
          std::find(broken_targets_.begin(), broken_targets_.end(), output.name) != broken_targets_.end();
      if (!found && !broken) {
        diagnostics_.add({output.place,
                          fmt::format("output '{0}' has no equation{1}", output.name, which),
                          fmt::format("'{0} = …', 'der({0}) = …' or an [implicit] entry '{0}'", output.name),
                          {}});
      }
    }
  }

  void read_starts() {
    const text::Value* const table = reader_.table("start");
    std::vector<std::string> targets;
    for (const Behaviour& behaviour : definition_.behaviours) {
      for (const Equation& equation : behaviour.equations) {
        const bool known = std::find(targets.begin(), targets.end(), equation.target) != targets.end();
        if (equation.kind != Equation::Kind::assignment && !known) targets.push_back(equation.target);
      }
    }
    for (const std::string& target : targets) {
      const text::Value* const written = table != nullptr ? table->find(target) : nullptr;
      definition_.starts.push_back(written != nullptr ? read_start(target, *written) : usual_start(target));
    }
    if (table == nullptr) return;
    for (const text::Entry& entry : table->entries) {
      if (std::find(targets.begin(), targets.end(), entry.key) != targets.end()) continue;
      report(entry.position, fmt::format("[start] names '{}', which is no state and no unknown", entry.key),
             {}, text::suggest(entry.key, targets));
    }
  }

  StartRule usual_start(const std::string& target) const {
    StartRule rule{target, {}, false};
    if (definition_.find_parameter("initial")) {
      rule.value.kind = text::Expression::Kind::name;
      rule.value.name = "initial";
      rule.value.column = 1;
    }
    return rule;
  }

  bool is_implicit(const std::string& target) const {
    return std::any_of(
        definition_.behaviours.begin(), definition_.behaviours.end(), [&](const Behaviour& behaviour) {
          return std::any_of(behaviour.equations.begin(), behaviour.equations.end(),
                             [&](const Equation& equation) {
                               return equation.kind == Equation::Kind::implicit && equation.target == target;
                             });
        });
  }

  StartRule read_start(const std::string& target, const text::Value& written) {
    StartRule rule = usual_start(target);
    const std::string what = fmt::format("start of '{}'", target);
    const text::Value* value = &written;
    if (written.kind == text::Value::Kind::table) {
      text::TableReader reader(definition_.file, written, what, diagnostics_);
      value = reader.find("guess");
      rule.at_rest = reader.boolean("at_rest").value_or(false);
      reader.finish();
    }
    if (value == nullptr) return rule;
    if (auto expression = expressions_.read(*value, what)) {
      std::vector<std::string> names = constants_;
      if (!rule.at_rest && !is_implicit(target)) {
        for (const InputPort& input : definition_.inputs) names.push_back(input.name);
        for (const std::string_view mode : {"in_initial", "in_operate", "in_hold"}) names.emplace_back(mode);
      }
      expressions_.resolve(*expression, *value, what, names);
      rule.value = std::move(*expression);
    }
    return rule;
  }

  text::TableReader& reader_;
  BlockDefinition& definition_;
  text::Diagnostics& diagnostics_;
  BlockExpressions expressions_;
  std::vector<std::string> constants_;       ///< what a condition or a start value may name
  std::vector<std::string> broken_targets_;  ///< reported already; not also "has no equation"
};

}  // namespace

void read_behaviours(text::TableReader& reader, BlockDefinition& definition, text::Diagnostics& diagnostics) {
  BehaviourReader(reader, definition, diagnostics).read();
}

}  // namespace oblique::diagram
