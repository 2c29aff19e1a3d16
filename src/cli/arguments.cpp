// SPDX-License-Identifier: MIT
#include "arguments.h"

#include <algorithm>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <oblique/text/diagnostic.h>

#include "terminal/terminal.h"
#include "verbs/verbs.h"

namespace oblique::cli {
namespace {

constexpr const char* kIntroduction =
    "Oblique, an analog computer in software: runs block diagrams with high-gain servo loops as the "
    "equations they\n"
    "are, patches mechanisms into such diagrams, and compares them with the exact motion.";

constexpr const char* kEpilogue =
    "First steps:\n"
    "  oblique compare diagrams/mechanisms/four-bar.toml     analog against exact, gain by gain\n"
    "  oblique run diagrams/lessons/triangle-side.toml       one oblique triangle, tracked by a servo "
    "amplifier\n"
    "  oblique blocks                                        what diagrams are made of\n"
    "Exit status: 0 done, 1 the answer is no, 2 the request or a file is wrong, 3 the solver failed.";

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands({})) names.push_back(verb->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// The first word that stands where the command should: neither an option nor the value of one.
std::optional<std::string> first_word(const CLI::App& app, const std::vector<std::string>& arguments) {
  bool is_value = false;
  for (const std::string& argument : arguments) {
    if (!is_value && !argument.starts_with("-")) return argument;
    const CLI::Option* const option = is_value ? nullptr : app.get_option_no_throw(argument);
    is_value = option != nullptr && option->get_items_expected_min() > 0;
  }
  return std::nullopt;
}

/// Of a verb that has verbs of its own, as `ensemble`, the one that was chosen with it; else the verb.
const CLI::App& innermost(const CLI::App& verb) {
  const std::vector<CLI::App*> chosen = verb.get_subcommands();
  return chosen.empty() ? verb : innermost(*chosen.front());
}

/// What the verb is called, with those around it: "ensemble run".
std::string full_name(const CLI::App& verb) {
  const CLI::App* const around = verb.get_parent();
  const bool is_innermost = around == nullptr || around->get_parent() == nullptr;
  return is_innermost ? verb.get_name() : full_name(*around) + " " + verb.get_name();
}

/// That a word stands where the name of a verb of `app` should, or that none does.
text::Diagnostic explain_verb(const CLI::App& app, const std::optional<std::string>& word,
                              const CLI::ParseError& error, const std::string& program) {
  const std::vector<std::string> verbs = verb_names(app);
  if (!word) return {{}, error.what(), {}, program + " --help lists the commands"};
  if (std::find(verbs.begin(), verbs.end(), *word) != verbs.end()) {  // hidden behind "--"
    return {{}, fmt::format("'--' stands before the command '{}'", *word), {}, "leave '--' out there"};
  }
  return {{}, fmt::format("there is no command '{}'", *word), {}, text::suggest(*word, verbs)};
}

/// "y.gain=10" of the arguments "y.gain", "=" and "10", which blanks have made of it.
std::optional<std::string> torn_setting(const std::vector<std::string>& arguments) {
  for (std::size_t k = 0; k + 1 < arguments.size(); ++k) {
    const std::string &word = arguments[k], &next = arguments[k + 1];
    if (word.starts_with("-")) continue;
    if (word.ends_with("=")) return word + next;
    if (next == "=") return word + next + (k + 2 < arguments.size() ? arguments[k + 2] : "");
    if (next.starts_with("=")) return word + next;
  }
  return std::nullopt;
}

/// CLI11's finding with the nearest verb or option added, which it does not know.
text::Diagnostic explain(const CLI::App& app, const CLI::ParseError& error,
                         const std::vector<std::string>& arguments) {
  if (app.get_subcommands().empty()) return explain_verb(app, first_word(app, arguments), error, "oblique");
  const CLI::App& chosen = innermost(app);
  const std::string verb = full_name(chosen);
  if (!chosen.get_subcommands({}).empty()) {
    const auto name = std::find(arguments.begin(), arguments.end(), chosen.get_name());
    const auto word = first_word(chosen, std::vector<std::string>(std::next(name), arguments.end()));
    return explain_verb(chosen, word, error, "oblique " + verb);
  }
  std::vector<std::string> names = option_names(chosen);
  for (const std::string& name : option_names(app)) names.push_back(name);
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    if (argument == "--") break;
    if (!argument.starts_with("--") || std::find(names.begin(), names.end(), name) != names.end()) continue;
    return {{}, fmt::format("'{}' has no option '{}'", verb, name), {}, text::suggest(name, names)};
  }
  if (const auto setting = torn_setting(arguments))
    return {{}, "a blank stands beside '='", *setting, "leave the blanks out"};
  return {{}, error.what(), {}, fmt::format("oblique {} --help tells how to call it", verb)};
}

}  // namespace

std::optional<ExitStatus> parse_arguments(int argc, char** argv, Chosen& chosen) {
  CLI::App app(kIntroduction, "oblique");
  app.footer(kEpilogue);
  app.set_version_flag("--version", "oblique " OBLIQUE_VERSION "\nsolver: " OBLIQUE_SOLVER);
  app.add_option("--blocks", chosen.session.block_directories,
                 "folder with further blocks (*.toml); may be repeated")
      ->type_name("DIR")
      ->allow_extra_args(false);
  app.require_subcommand(1);
  app.fallthrough();
  add_run(app, chosen);
  add_sweep(app, chosen);
  add_operate(app, chosen);
  add_check(app, chosen);
  add_solve(app, chosen);
  add_modes(app, chosen);
  add_patch(app, chosen);
  add_compare(app, chosen);
  add_report(app, chosen);
  add_atlas(app, chosen);
  add_fit(app, chosen);
  add_ensemble(app, chosen);
  add_draw(app, chosen);
  add_animate(app, chosen);
  add_studio(app, chosen);
  add_blocks(app, chosen);
  add_machines(app, chosen);
  if (argc < 2) {
    print(app.help());
    return ExitStatus::done;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return static_cast<ExitStatus>(app.exit(success));
  } catch (const CLI::ParseError& error) {
    print_error(message(explain(app, error, std::vector<std::string>(argv + 1, argv + argc))));
    return ExitStatus::bad_request;
  }
  return std::nullopt;
}

}  // namespace oblique::cli
