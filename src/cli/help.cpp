// SPDX-License-Identifier: MIT
#include "help.h"

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace oblique::cli {
namespace {

constexpr const char* kFirstSteps =
    "First steps:\n"
    "  oblique run diagrams/course/1-open-amplifier.toml     the first lesson of the course, docs/course\n"
    "  oblique run diagrams/lessons/triangle-side.toml       one oblique triangle, tracked by a servo "
    "amplifier\n"
    "  oblique compare diagrams/mechanisms/four-bar.toml     analog against exact, gain by gain\n"
    "  oblique blocks                                        what diagrams are made of\n"
    "COMMAND --help tells all about one.\n"
    "Exit status: 0 done, 1 the answer is no, 2 the request or a file is wrong, 3 the solver failed.";

/// Verbs, and how each is called in the folder of the project.
constexpr std::array kExamples{
    std::pair{"run", "oblique run diagrams/lessons/triangle-side.toml --set c.gain=1000"},
    std::pair{"sweep",
              "oblique sweep diagrams/lessons/triangle-side.toml --vary c.gain=1e2,1e3,1e4 --measure "
              "'max(side)'"},
    std::pair{"operate", "oblique operate diagrams/lessons/circle.toml"},
    std::pair{"check", "oblique check diagrams/lessons/triangle-side.toml"},
    std::pair{"solve", "oblique solve diagrams/mechanisms/four-bar.toml --positions 13"},
    std::pair{"modes", "oblique modes diagrams/mechanisms/four-bar.toml --at '30 deg'"},
    std::pair{"patch", "oblique patch diagrams/mechanisms/four-bar.toml --gain 1e4 -o patched.toml"},
    std::pair{"compare", "oblique compare diagrams/mechanisms/four-bar.toml --gain 1e2,1e4"},
    std::pair{"report", "oblique report diagrams/mechanisms/four-bar.toml -o report.html"},
    std::pair{"atlas", "oblique atlas diagrams/atlas -o site"},
    std::pair{
        "fit",
        "oblique fit diagrams/mechanisms/six-bar-above.toml --path path.csv --free AB=70..90,CD=140..160"},
    std::pair{"draw", "oblique draw diagrams/mechanisms/jansen.toml -o leg.svg"},
    std::pair{"animate", "oblique animate diagrams/mechanisms/jansen.toml -o leg.html"},
    std::pair{"studio", "oblique studio diagrams/mechanisms/four-bar.toml -o studio.html --stay"},
    std::pair{"blocks", "oblique blocks servo-amplifier"},
    std::pair{"machines", "oblique machines tr-10"},
};

std::string names(const std::set<CLI::Option*>& options) {
  std::vector<std::string> all;
  for (const CLI::Option* option : options) all.push_back(option->get_name());
  std::sort(all.begin(), all.end());
  return fmt::format("{}", fmt::join(all, ", "));
}

/// Beside an option stands what its value is called, and in words below what CLI11 marks with signs: bounds,
/// default, what it goes with.
class Help : public CLI::Formatter {
 public:
  Help() {
    label("SUBCOMMAND", "COMMAND");
    label("Positionals", "Arguments");
    label("TEXT", "VALUE");
    label("INT", "N");
    label("UINT", "N");
    column_width(28);
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_positional() || option->get_type_size() == 0) return {};
    const std::string type = option->get_type_name();  // "N:INT in [2 - 1000]" where it is checked
    return " " + get_label(type.substr(0, type.find(':')));
  }

  std::string make_option_desc(const CLI::Option* option) const override {
    std::vector<std::string> notes;
    if (option->get_required() && !option->get_positional()) notes.emplace_back("required");
    const std::string type = option->get_type_name();
    const std::size_t open = type.find('['), dash = type.find(" - "), close = type.find(']');
    if (close != std::string::npos)
      notes.push_back(fmt::format("{} to {}", type.substr(open + 1, dash - open - 1),
                                  type.substr(dash + 3, close - dash - 3)));
    if (!option->get_default_str().empty()) notes.push_back("default " + option->get_default_str());
    if (!option->get_needs().empty()) notes.push_back("with " + names(option->get_needs()));
    if (!option->get_excludes().empty()) notes.push_back("not with " + names(option->get_excludes()));
    std::string text = option->get_description();
    if (notes.empty()) return text;
    const bool has_notes = text.ends_with(')');
    if (has_notes) text.pop_back();
    return fmt::format("{}{}{})", text, has_notes ? "; " : " (", fmt::join(notes, "; "));
  }
};

void set_up(CLI::App& app, const std::shared_ptr<Help>& help) {
  app.formatter(help);
  app.get_help_ptr()->description("print this help");
  for (CLI::App* const verb : app.get_subcommands({})) {
    verb->group("Commands");
    set_up(*verb, help);
  }
}

}  // namespace

void write_help(CLI::App& app) {
  set_up(app, std::make_shared<Help>());
  app.footer(kFirstSteps);
  for (const auto& [name, example] : kExamples) {
    CLI::App* const verb = app.get_subcommand(name);
    const std::string more = verb->get_footer();
    verb->footer(fmt::format("For example: {}{}{}", example, more.empty() ? "" : "\n", more));
  }
}

}  // namespace oblique::cli
