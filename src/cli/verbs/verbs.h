// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "arguments.h"

// What the descriptions of the verbs share: only the files that read the command line see it.
namespace oblique::cli {

/// Lets a verb, once chosen, do its work on its request.
template <class Request>
void choose(CLI::App* verb, Chosen& chosen, const std::shared_ptr<Request>& request,
            ExitStatus (*work)(const Session&, const Request&)) {
  verb->callback([&chosen, request, work] {
    chosen.work = [&chosen, request, work] { return work(chosen.session, *request); };
  });
}

inline constexpr std::uint64_t kAnyNumber = std::numeric_limits<std::uint64_t>::max();

/// A whole number, written in digits, from `least` to `most`.
inline CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  const auto check = [least, most](const std::string& text) -> std::string {
    std::uint64_t number = 0;
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, number);
    if (error == std::errc() && at == end && least <= number && number <= most) return {};
    return fmt::format("{}; expected a whole number from {}{}", text, least,
                       most == kAnyNumber ? " on" : fmt::format(" to {}", most));
  };
  return {check, most == kAnyNumber ? "INT" : fmt::format("INT in [{} - {}]", least, most), "whole_number"};
}

/// -o and --columns of a verb that writes a table.
template <class Request>
void add_table_options(CLI::App* verb, Request& request) {
  verb->add_option("-o,--output", request.output,
                   "write all rows and columns to FILE, which ends in .csv, .npy (NumPy), .mat (MATLAB) or "
                   ".json")
      ->type_name("FILE");
  verb->add_option("--columns", request.columns, "write these columns only, in this order")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME,NAME,...");
}

/// --plot of a verb that draws curves; `what` begins its description.
template <class Request>
void add_plot_option(CLI::App* verb, Request& request, const std::string& what) {
  verb->add_option("--plot", request.plot,
                   what + ": to FILE.svg or FILE.png, or with - in the terminal in place of the tables")
      ->type_name("FILE");
  verb->add_option("--theme", request.theme,
                   "of the picture of --plot (default auto: light or dark as the reader's screen)")
      ->type_name("auto|light|dark");
}

/// --method of a verb that patches.
template <class Request>
void add_method(CLI::App* verb, Request& request) {
  verb->add_option("--method", request.method,
                   "triangles: servo-tracked oblique triangles; gradient: integrators that descend, for any "
                   "group; paper: "
                   "a class III group as its source draws it")
      ->type_name("triangles|gradient|paper")
      ->capture_default_str();
}

/// --split and --slower of a verb that patches.
inline void add_triad_choice(CLI::App* verb, TriadChoice& choice) {
  verb->add_option(
          "--split", choice.split,
          "how to take a triad apart: the leg whose triangle carries the variable length, the leg that "
          "closes the loop, the third (default: the best split)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LEG,LEG,LEG");
  verb->add_option(
      "--slower", choice.slower,
      "how many times slower the outer loop of a triad is (default: 100, or more where that is needed)");
}

/// --gain, --bandwidth, --method, --split and --slower of a verb that runs one patch beside other work;
/// where that is to be asked for, `needed` asks for it.
inline void add_patch_choice(CLI::App* verb, PatchChoice& choice, CLI::Option* needed = nullptr) {
  verb->add_option("--gain", choice.gain, "gain of the servo amplifiers in the patch")->capture_default_str();
  verb->add_option("--bandwidth", choice.bandwidth,
                   "bandwidth of the servo amplifiers, in Hz or with a unit (default: 100 times the crank's "
                   "frequency)");
  add_method(verb, choice);
  add_triad_choice(verb, choice.triads);
  if (needed == nullptr) return;
  for (const char* option : {"--gain", "--bandwidth", "--method", "--split", "--slower"})
    verb->get_option(option)->needs(needed);
}

// Each adds a verb with its options.
void add_run(CLI::App& app, Chosen& chosen);
void add_sweep(CLI::App& app, Chosen& chosen);
void add_operate(CLI::App& app, Chosen& chosen);
void add_check(CLI::App& app, Chosen& chosen);
void add_solve(CLI::App& app, Chosen& chosen);
void add_modes(CLI::App& app, Chosen& chosen);
void add_patch(CLI::App& app, Chosen& chosen);
void add_compare(CLI::App& app, Chosen& chosen);
void add_report(CLI::App& app, Chosen& chosen);
void add_atlas(CLI::App& app, Chosen& chosen);
void add_fit(CLI::App& app, Chosen& chosen);
void add_ensemble(CLI::App& app, Chosen& chosen);
void add_draw(CLI::App& app, Chosen& chosen);
void add_animate(CLI::App& app, Chosen& chosen);
void add_studio(CLI::App& app, Chosen& chosen);
void add_blocks(CLI::App& app, Chosen& chosen);
void add_machines(CLI::App& app, Chosen& chosen);

}  // namespace oblique::cli
