// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

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
      ->type_name("NAME,NAME,…");
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

// Each adds a verb with its options.
void add_run(CLI::App& app, Chosen& chosen);
void add_check(CLI::App& app, Chosen& chosen);
void add_solve(CLI::App& app, Chosen& chosen);
void add_modes(CLI::App& app, Chosen& chosen);
void add_patch(CLI::App& app, Chosen& chosen);
void add_compare(CLI::App& app, Chosen& chosen);
void add_report(CLI::App& app, Chosen& chosen);
void add_fit(CLI::App& app, Chosen& chosen);
void add_draw(CLI::App& app, Chosen& chosen);
void add_animate(CLI::App& app, Chosen& chosen);
void add_blocks(CLI::App& app, Chosen& chosen);
void add_machines(CLI::App& app, Chosen& chosen);

}  // namespace oblique::cli
