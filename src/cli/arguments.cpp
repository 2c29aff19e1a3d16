// SPDX-License-Identifier: MIT
#include "arguments.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <oblique/text/diagnostic.h>

#include "help.h"
#include "terminal/terminal.h"
#include "verbs/verbs.h"

namespace oblique::cli {
namespace {

constexpr const char* kIntroduction =
    "Oblique, an analog computer in software: runs block diagrams with high-gain servo loops as the "
    "equations they\n"
    "are, patches mechanisms into such diagrams, and compares them with the exact motion.";

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

/// A word that blanks have torn apart.
struct Torn {
  char at;  ///< '=' or ','
  std::string whole;
};

/// "y.gain=10" of the arguments "y.gain", "=" and "10"; "c.gain=1,2" of "c.gain=1," and "2".
std::optional<Torn> torn_word(const std::vector<std::string>& arguments) {
  for (std::size_t k = 0; k + 1 < arguments.size(); ++k) {
    const std::string &word = arguments[k], &next = arguments[k + 1];
    if (word.starts_with("-")) continue;
    for (const char at : {'=', ','}) {
      if (!word.ends_with(at) && !next.starts_with(at)) continue;
      const bool stands_alone = next.size() == 1 && next.starts_with(at) && k + 2 < arguments.size();
      return Torn{at, word + next + (stands_alone ? arguments[k + 2] : "")};
    }
  }
  return std::nullopt;
}

/// Whether it is written as an option, and CLI11 would know it for one: not a number, not -oFILE.
bool is_unknown_option(const std::string& argument, const std::vector<std::string>& names,
                       const CLI::App& verb) {
  const std::string name = argument.substr(0, argument.find('='));
  if (std::find(names.begin(), names.end(), name) != names.end()) return false;
  if (name.starts_with("--")) return true;
  return name.size() > 2 && name.front() == '-' && std::isalpha(static_cast<unsigned char>(name[1])) != 0 &&
         verb.get_option_no_throw(name.substr(0, 2)) == nullptr;
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
    if (argument == "--") break;
    if (!is_unknown_option(argument, names, chosen)) continue;
    const std::string name = argument.substr(0, argument.find('='));
    return {{}, fmt::format("'{}' has no option '{}'", verb, name), {}, text::suggest(name, names)};
  }
  if (const auto torn = torn_word(arguments))
    return {{}, fmt::format("a blank stands beside '{}'", torn->at), torn->whole, "leave the blanks out"};
  return {{}, error.what(), {}, fmt::format("oblique {} --help tells how to call it", verb)};
}

}  // namespace

std::optional<ExitStatus> parse_arguments(int argc, char** argv, Chosen& chosen) {
  CLI::App app(kIntroduction, "oblique");
  app.set_version_flag("--version", "oblique " OBLIQUE_VERSION "\nsolver: " OBLIQUE_SOLVER,
                       "print the version");
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
  write_help(app);
  if (argc < 2) {
    print(app.help());
    return ExitStatus::done;
  }
  std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.front() == "help") {  // of all, or of the verb behind it
    arguments.erase(arguments.begin());
    const std::vector<std::string> verbs = verb_names(app);
    if (arguments.empty() || std::find(verbs.begin(), verbs.end(), arguments.front()) != verbs.end())
      arguments.emplace_back("--help");
  }
  if (const auto empty = std::find(arguments.begin(), arguments.end(), ""); empty != arguments.end()) {
    const std::string before =
        empty == arguments.begin() ? "" : fmt::format(" behind '{}'", *std::prev(empty));
    print_error(message({{},
                         fmt::format("the argument{} is empty", before),
                         "a name or a value",
                         "leave it out; a variable of the shell that is not set makes one"}));
    return ExitStatus::bad_request;
  }
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success& success) {  // --help, --version
    return static_cast<ExitStatus>(app.exit(success));
  } catch (const CLI::ParseError& error) {
    print_error(message(explain(app, error, arguments)));
    return ExitStatus::bad_request;
  }
  std::vector<std::string> names;
  for (const CLI::App* verb = &app; verb != nullptr;) {
    for (const CLI::Option* const option : verb->get_options()) {
      const std::vector<std::string>& spelled = option->get_lnames();
      names.insert(names.end(), spelled.begin(), spelled.end());
    }
    const std::vector<CLI::App*> chosen_below = verb->get_subcommands();
    verb = chosen_below.empty() ? nullptr : chosen_below.front();
  }
  know_options(std::move(names));
  return std::nullopt;
}

}  // namespace oblique::cli
