// SPDX-License-Identifier: MIT
// The verbs for plans of ensembles.
#include "verbs/verbs.h"

namespace oblique::cli {
namespace {

void add_plan(CLI::App* verb, EnsembleRequest& request) {
  verb->add_option("PLAN", request.plan, "plan file (oblique-ensemble/1)")->required();
}

void add_folder(CLI::App* verb, EnsembleRequest& request) {
  verb->add_option("-o,--output", request.folder, "folder of the chunks")->type_name("DIR")->required();
}

void add_chunks(CLI::App* verb, EnsembleRequest& request) {
  verb->add_option("--chunks", request.chunks,
                   "cut the ensemble into so many chunks (default: of about 1000 runs, at most 1000 of them)")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
}

}  // namespace

void add_ensemble(CLI::App& app, Chosen& chosen) {
  CLI::App* const ensemble = app.add_subcommand(
      "ensemble", "Run the plan of an ensemble, in chunks that any number of computers share");
  ensemble->require_subcommand(1);
  ensemble->footer(
      "The same plan gives the same numbers, whoever runs which chunk, in whatever order; what is there is "
      "not run "
      "again. docs/ensembles.md shows it.");

  auto run = std::make_shared<EnsembleRequest>();
  CLI::App* verb = ensemble->add_subcommand("run", "Run all chunks, or one, that are not there yet");
  add_plan(verb, *run);
  verb->add_option("--chunk", run->chunk,
                   "only the I-th of N chunks; I counts from 0 to N − 1 or from 1 to N (N/N is 0/N)")
      ->type_name("I/N");
  add_chunks(verb, *run);
  add_folder(verb, *run);
  verb->add_option("--jobs", run->jobs, "threads (default: as many as the processor has)")
      ->check(CLI::PositiveNumber);
  verb->add_option("--table", run->table, "then write the table of all runs, as `gather` does")
      ->type_name("FILE");
  choose(verb, chosen, run, run_ensemble);

  auto gather = std::make_shared<EnsembleRequest>();
  verb = ensemble->add_subcommand("gather",
                                  "Write the table of all runs, or say which chunks are missing (status 1)");
  add_plan(verb, *gather);
  add_folder(verb, *gather);
  verb->add_option("--table", gather->table, "the table: .csv, .npy (NumPy), .mat (MATLAB) or .json")
      ->type_name("FILE")
      ->required();
  choose(verb, chosen, gather, gather_ensemble);

  auto status = std::make_shared<EnsembleRequest>();
  verb = ensemble->add_subcommand(
      "status", "List the chunks that are missing or damaged (status 1 where there are any)");
  add_plan(verb, *status);
  add_folder(verb, *status);
  choose(verb, chosen, status, show_ensemble);

  auto script = std::make_shared<EnsembleRequest>();
  verb = ensemble->add_subcommand("script", "Write the script that a cluster runs");
  add_plan(verb, *script);
  verb->add_flag("--slurm", script->slurm, "for Slurm: an array of jobs, one a chunk");
  add_chunks(verb, *script);
  verb->add_option("--folder", script->folder, "folder of the chunks (default: PLAN with .chunks)")
      ->type_name("DIR");
  verb->add_option("--jobs", script->jobs, "threads of each job (default 1)")->check(CLI::PositiveNumber);
  verb->add_option("--time", script->time, "the most that a job takes: minutes, or 2:00:00")
      ->type_name("TIME");
  verb->add_option("--memory", script->memory, "the memory of a job, for example 2G")->type_name("SIZE");
  verb->add_option("-o,--output", script->output, "write the script to FILE.sh (default: print it)")
      ->type_name("FILE");
  choose(verb, chosen, script, script_ensemble);
}

}  // namespace oblique::cli
