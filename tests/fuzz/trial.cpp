// SPDX-License-Identifier: MIT
#include "trial.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <regex>
#include <set>

#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/solve_error.h>

#include "own_blocks.h"

namespace oblique::fuzz {
namespace {

/// A random diagram takes some hundred steps; one that chatters as fast as its solver can, many more.
constexpr long kMostSteps = 5'000;

/// A message without what renaming, the order of the blocks and rounding change: quoted names, also where
/// several are listed, and numbers.
std::string without_particulars(std::string_view message) {
  static const std::regex particulars("'[^']*'(, '[^']*')*(, …)?|[0-9]+([.][0-9]+)?(e[-+]?[0-9]+)?");
  return std::regex_replace(std::string(message), particulars, "");
}

bool is_finite(const solve::Trajectory& table) {
  for (const double value : table.values()) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

void refuse(Trial& trial, std::string_view stage, const text::Error& error) {
  trial.end = Trial::End::refused;
  trial.says = stage;
  trial.message = error.what();
  if (error.diagnostics().empty() || error.diagnostics().front().what.empty()) {
    trial.end = Trial::End::broken;
    trial.says = "a refusal without words";
  }
}

Trial attempt(const std::function<void(Trial&)>& way) {
  Trial trial;
  try {
    way(trial);
  } catch (const solve::SolveError& error) {
    refuse(trial, fmt::format("solve {}", static_cast<int>(error.kind())), error);
    if (error.kind() == solve::SolveError::Kind::step_budget) trial.end = Trial::End::over_budget;
    if (!std::isfinite(error.time())) {
      trial.end = Trial::End::broken;
      trial.says = "a refusal at no time";
    }
  } catch (const diagram::DiagramError& error) {
    refuse(trial, "diagram", error);
  } catch (const network::NetworkError& error) {
    refuse(trial, "network", error);
  } catch (const std::exception& error) {
    trial.says = fmt::format("an exception of no stage: {}", error.what());
  }
  return trial;
}

void run_whole(const diagram::Diagram& diagram, const TrialOptions& asked, Trial& trial) {
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library());
  const network::Program program(network::assemble(flat));
  solve::RunOptions options = solve::options_of(diagram.run);
  if (asked.method) options.method = *asked.method;
  if (asked.tolerance) options.tolerance = *asked.tolerance;
  if (asked.until) options.until = *asked.until;
  if (asked.samples) options.samples = *asked.samples;
  options.from = asked.from;
  options.max_steps = kMostSteps;
  // Of all attempts, and of steps that events end: at every evaluation, of which a step has some ten.
  constexpr long kMostAsked = 30 * kMostSteps;
  long asked_to_end = 0;
  options.interrupted = [&] { return ++asked_to_end > kMostAsked; };
  try {
    trial.run = solve::run(program, flat, options);
  } catch (const solve::SolveError&) {
    if (asked_to_end <= kMostAsked) throw;
    trial.end = Trial::End::over_budget;
    return;
  }
  if (!is_finite(trial.run->trajectory)) {
    trial.says = "an output that is no finite number";
    return;
  }
  if (trial.run->state.time < options.until) {
    trial.end = Trial::End::over_budget;
    return;
  }
  if (trial.run->trajectory.rows() != static_cast<std::size_t>(options.samples)) {
    trial.says = "rows are missing";
    return;
  }
  trial.end = trial.run->warnings.empty() ? Trial::End::clean : Trial::End::warned;
  // It is not the run that would have been with more of them.
  if (std::any_of(trial.run->warnings.begin(), trial.run->warnings.end(),
                  [](const text::Diagnostic& warning) {
                    return warning.what.find("a finer run takes too many steps") != std::string::npos;
                  })) {
    trial.end = Trial::End::over_budget;
    return;
  }
  std::multiset<std::string>
      said;  // of several at one instant, the order of the blocks says which comes first
  for (const text::Diagnostic& warning : trial.run->warnings) {
    said.insert(without_particulars(warning.what.substr(0, warning.what.find(':'))));
    trial.message += text::to_string(warning) + "\n";
  }
  for (const std::string& what : said) trial.says += what + ";";
}

}  // namespace

Trial try_diagram(const std::string& text, const TrialOptions& options) {
  return attempt([&](Trial& trial) { run_whole(diagram::parse_diagram(text, "fuzz.toml"), options, trial); });
}

Trial try_diagram(const diagram::Diagram& diagram, const TrialOptions& options) {
  return attempt([&](Trial& trial) { run_whole(diagram, options, trial); });
}

}  // namespace oblique::fuzz
