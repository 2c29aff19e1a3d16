// SPDX-License-Identifier: MIT
// The verbs for mechanisms.
#include "verbs/verbs.h"

namespace oblique::cli {

void add_solve(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<SolveRequest>();
  CLI::App* const verb = app.add_subcommand("solve", "Solve a mechanism exactly: its motion over one turn");
  verb->add_option("MECHANISM", request->mechanism, "mechanism file (oblique-mechanism/1)")->required();
  verb->add_option("--positions", request->positions, "rows over the turn, both ends included")
      ->capture_default_str()
      ->check(whole_number(2, 10'000'000));
  verb->add_option("--until", request->until,
                   "end of the motion, for example \"2 s\" (default: one turn of the first drive)")
      ->type_name("T");
  verb->add_option(
          "--at-limit", request->at_limit,
          "where the mechanism can go no further: open (rows without numbers), stop, or reverse the drives")
      ->type_name("open|stop|reverse");
  verb->add_flag("--check", request->check,
                 "hold the motion against the mechanism's [expect]; status 1 where it fails");
  verb->add_flag(
      "--analysis", request->analysis,
      "with -o: write kinematic coefficients, instant centres, transmission angles and inertia too");
  add_table_options(verb, *request);
  choose(verb, chosen, request, solve_mechanism);
}

void add_modes(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<ModesRequest>();
  CLI::App* const verb = app.add_subcommand("modes", "List every way to assemble each group of a mechanism");
  verb->add_option("MECHANISM", request->mechanism, "mechanism file (oblique-mechanism/1)")->required();
  verb->add_option("--at", request->at,
                   "where the first drive stands, for example \"30 deg\" (default: its start)")
      ->type_name("VALUE");
  verb->add_flag("--json", request->json, "print JSON instead of the tables");
  choose(verb, chosen, request, show_modes);
}

void add_patch(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<PatchRequest>();
  CLI::App* const verb = app.add_subcommand(
      "patch", "Patch a mechanism: the diagram that simulates it; or put a diagram onto a machine");
  verb->add_option("FILE", request->mechanism,
                   "mechanism file (oblique-mechanism/1); with --machine also a diagram (oblique-diagram/1)")
      ->required();
  verb->add_option("--gain", request->gain, "gain of the servo amplifiers; inf: ideal")
      ->capture_default_str();
  verb->add_option(
      "--bandwidth", request->bandwidth,
      "bandwidth of the servo amplifiers, in Hz or with a unit; inf: algebraic loops "
      "(default: 100 times the crank's frequency; with --machine less where its elements need it)");
  add_method(verb, *request);
  verb->add_flag("--derivatives", request->derivatives,
                 "velocities and accelerations too, as further circuits");
  add_triad_choice(verb, request->triads);
  verb->add_option("--unit", request->unit,
                   "1 machine unit of the coordinates, for example \"2.5 m\" (default: by the exact motion)")
      ->type_name("LENGTH");
  verb->add_option(
          "--period", request->period,
          "machine time that the motion takes, for example \"20 s\" (default: as long as the motion itself)")
      ->type_name("T");
  verb->add_flag("--force", request->force,
                 "patch it even where it is unstable, flips on the way, or needs a kind of element that the "
                 "machine does not have");
  verb->add_option("-o,--output", request->output, "write the diagram to FILE.toml")->type_name("FILE");
  verb->add_option("--machine", request->machine,
                   "write it in the elements of this machine, with a component list: what it needs and what "
                   "is missing")
      ->type_name("NAME");
  verb->add_option(
          "--sheets", request->sheets,
          "with --machine: write PREFIX-patch.csv (connections), PREFIX-pots.csv (settings), "
          "PREFIX-static.csv (static test), PREFIX-outputs.csv (what is read where), PREFIX-modes.csv (how "
          "long, and in which modes), of a diagram PREFIX-scales.csv (what its signals stand for), and "
          "PREFIX.txt with all of them for paper")
      ->type_name("PREFIX");
  verb->add_option(
          "--time-scale", request->time_scale,
          "of a diagram: seconds of the machine for 1 s of it (default: 1, or as its integrators ask)")
      ->type_name("N");
  verb->add_option("--segments", request->segments,
                   "of a diagram: straight lines of a function generator, at the most (default: 10)")
      ->type_name("N")
      ->check(whole_number(1, 1000));
  choose(verb, chosen, request, patch_file);
}

void add_compare(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<CompareRequest>();
  CLI::App* const verb = app.add_subcommand(
      "compare",
      "Compare the patched mechanism with its exact motion, gain by gain; or a diagram with its ideal self");
  verb->add_option("FILE", request->mechanism,
                   "mechanism file (oblique-mechanism/1), or a diagram (oblique-diagram/1) with --machine or "
                   "--tolerance")
      ->required();
  verb->add_option("--gain", request->gains, "gains of the servo amplifiers (default 1e2,1e3,1e4,1e5,1e6)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("G,G,...");
  verb->add_option(
          "--bandwidth", request->bandwidths,
          "bandwidths of the servo amplifiers, in Hz or with a unit; each is run with each gain "
          "(default: 100 times the crank's frequency; with --machine less where its elements need it)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("B,B,...");
  verb->add_option("--method", request->methods,
                   "which of triangles, gradient and paper to compare, as in `patch` "
                   "(default triangles)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("M,M,...");
  add_triad_choice(verb, request->triads);
  verb->add_option(
          "--machine", request->machine,
          "run it in this machine's elements too, and say what each published figure adds to the error "
          "(oblique machines lists them); one gain (default 1e6)")
      ->type_name("NAME");
  verb->add_flag(
      "--budget", request->budget,
      "say whose tolerances the errors come from: how far that of each element displaces the points "
      "(with --tolerance or --machine); one gain (default 1e6)");
  CLI::Option* const monte_carlo =
      verb->add_option("--monte-carlo", request->runs,
                       "run it N times more, each with tolerances drawn anew; one gain (default 1e6)")
          ->type_name("N")
          ->check(whole_number(1, 10'000'000));
  verb->add_option("--tolerance", request->tolerance,
                   "how far the weights of summers and integrators and the errors of multipliers scatter, "
                   "uniformly on both sides, for example 0.1% (default with --machine: as its profile says)")
      ->type_name("X");
  verb->add_option("--seed", request->seed, "chooses the random numbers")
      ->capture_default_str()
      ->check(whole_number(0, kAnyNumber))
      ->needs(monte_carlo);
  verb->add_option("--first-run", request->first_run,
                   "number of the first run; with --monte-carlo 1 it repeats one")
      ->capture_default_str()
      ->check(whole_number(0, kAnyNumber))
      ->needs(monte_carlo);
  verb->add_option("--threads", request->threads,
                   "runs at a time, which changes no result (default: what the processor has)")
      ->type_name("T")
      ->check(whole_number(1, 1024));
  CLI::Option* const yield =
      verb->add_option(
              "--yield", request->yield,
              "say in how many of these runs, and of all machines, the largest error is below X: 1% of "
              "the largest link, or a length")
          ->type_name("X")
          ->needs(monte_carlo);
  verb->add_option("--until-within", request->until_within,
                   "run only as many as it takes to know that part within ±P, N at the most, for example 1%")
      ->type_name("P")
      ->needs(yield);
  add_plot_option(verb, *request,
                  "draw the error over the gain with its slope, the error along the turn, and of "
                  "--monte-carlo the bands of the error along the turn and how often which error occurs");
  verb->add_flag("--json", request->json, "print JSON instead of the table");
  verb->add_flag("--timings", request->timings,
                 "write into the JSON how many seconds it took, which differ from run to run");
  verb->add_option("-o,--output", request->output, "write the JSON to FILE.json")->type_name("FILE");
  choose(verb, chosen, request, compare_mechanism);
}

void add_report(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<ReportRequest>();
  CLI::App* const verb = app.add_subcommand("report",
                                            "Report in one page: on a mechanism its groups, motion, patch, "
                                            "convergence, stability; on a diagram its "
                                            "circuit, equations, curves, scaling, settings");
  verb->add_option("FILE", request->file, "mechanism or diagram file")->required();
  verb->add_option("-o,--output", request->output, "write the page to FILE.html")
      ->required()
      ->type_name("FILE");
  add_patch_choice(verb, request->patch);
  verb->add_option("--machine", request->machine,
                   "add what the patch needs of this machine, and its sheets: settings of potentiometers, "
                   "connections, static test")
      ->type_name("NAME");
  verb->add_option("--theme", request->theme,
                   "auto: light or dark as the reader's screen; on paper always light")
      ->capture_default_str()
      ->type_name("auto|light|dark");
  verb->footer("What is said of a patch and of a machine is asked of a mechanism; a diagram has its own.");
  choose(verb, chosen, request, report_file);
}

void add_fit(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<FitRequest>();
  CLI::App* const verb = app.add_subcommand(
      "fit", "Fit a mechanism: dimensions that bring the path of a point nearest to given points");
  verb->add_option("MECHANISM", request->mechanism, "mechanism file (oblique-mechanism/1)")->required();
  verb->add_option(
          "--path", request->path,
          "points wanted: columns P.x and P.y of a point P; with a drive's angle [rad] or t [s] each "
          "at that moment, otherwise each to the nearest place of the path")
      ->required()
      ->type_name("FILE");
  verb->add_option(
          "--free", request->free,
          "dimensions that may change: a body (its length), body.sides, a mark body.M, a frame point D, or "
          "one number of these (D.x); bounds as in CD=130..150 (default: half to twice a length, "
          "half the largest length about a coordinate)")
      ->required()
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME,...");
  verb->add_option("--starts", request->starts,
                   "number of searches, spread over the bounds; 1: from the file only")
      ->capture_default_str()
      ->check(whole_number(1, 10'000));
  verb->add_option("-o,--output", request->output, "write the fitted mechanism to NEW.toml")
      ->type_name("NEW");
  choose(verb, chosen, request, fit_mechanism);
}

}  // namespace oblique::cli
