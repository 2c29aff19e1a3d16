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

/// CLI11's finding with the nearest verb or option added, which it does not know.
text::Diagnostic explain(const CLI::App& app, const CLI::ParseError& error,
                         const std::vector<std::string>& arguments) {
  const auto chosen = app.get_subcommands();
  if (chosen.empty()) {
    const auto word = first_word(app, arguments);
    const std::vector<std::string> verbs = verb_names(app);
    if (!word) return {{}, error.what(), {}, "oblique --help lists the commands"};
    if (std::find(verbs.begin(), verbs.end(), *word) != verbs.end()) {  // hidden behind "--"
      return {{}, fmt::format("'--' stands before the command '{}'", *word), {}, "leave '--' out there"};
    }
    return {{}, fmt::format("there is no command '{}'", *word), {}, text::suggest(*word, verbs)};
  }
  std::vector<std::string> names = option_names(*chosen.front());
  for (const std::string& name : option_names(app)) names.push_back(name);
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    if (argument == "--") break;
    if (!argument.starts_with("--") || std::find(names.begin(), names.end(), name) != names.end()) continue;
    return {{},
            fmt::format("'{}' has no option '{}'", chosen.front()->get_name(), name),
            {},
            text::suggest(name, names)};
  }
  return {{},
          error.what(),
          {},
          fmt::format("oblique {} --help tells how to call it", chosen.front()->get_name())};
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
  add_fit(app, chosen);
  add_draw(app, chosen);
  add_animate(app, chosen);
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
