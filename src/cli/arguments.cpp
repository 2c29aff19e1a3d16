// SPDX-License-Identifier: MIT
#include "arguments.h"

#include <algorithm>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <oblique/text/diagnostic.h>

#include "terminal.h"

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
Diagnostic explain(const CLI::App& app, const CLI::ParseError& error,
                   const std::vector<std::string>& arguments) {
  const auto chosen = app.get_subcommands();
  if (chosen.empty()) {
    const auto word = first_word(app, arguments);
    const std::vector<std::string> verbs = verb_names(app);
    if (!word) return {{}, error.what(), {}, "oblique --help lists the commands"};
    if (std::find(verbs.begin(), verbs.end(), *word) != verbs.end()) {  // hidden behind "--"
      return {{}, fmt::format("'--' stands before the command '{}'", *word), {}, "leave '--' out there"};
    }
    return {{}, fmt::format("there is no command '{}'", *word), {}, suggest(*word, verbs)};
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
            suggest(name, names)};
  }
  return {{},
          error.what(),
          {},
          fmt::format("oblique {} --help tells how to call it", chosen.front()->get_name())};
}

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

void add_run(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<RunRequest>();
  CLI::App* const verb = app.add_subcommand("run", "Run a diagram: its outputs over time");
  verb->add_option("DIAGRAM", request->diagram, "diagram file (oblique-diagram/1)")->required();
  add_table_options(verb, *request);
  verb->add_option("--until", request->until, "end of the run, for example 2*pi or \"500 ms\"")
      ->type_name("T");
  verb->add_option("--set", request->settings, "change a parameter: block.parameter=value; may be repeated")
      ->type_name("SETTING")
      ->allow_extra_args(false);
  verb->add_option("--from", request->from,
                   "go on from the state that an earlier run saved; --until is then later")
      ->type_name("STATE");
  verb->add_option("--save", request->save,
                   "save the state at the end, or where Ctrl-C interrupts the run, to STATE.toml")
      ->type_name("STATE");
  verb->add_flag("--events", request->events, "list what switched, and when");
  verb->add_flag("--check", request->check,
                 "hold the run against the diagram's [expect]; status 1 where it fails");
  verb->add_flag(
      "--static-test", request->static_test,
      "print every element's output and every integrator's input in initial condition; nothing is run");
  verb->add_flag("--halt-on-overload", request->halt_on_overload,
                 "end the run with status 1 where a signal first leaves ±1 machine unit");
  choose(verb, chosen, request, run_diagram);
}

void add_check(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<CheckRequest>();
  CLI::App* const verb = app.add_subcommand(
      "check",
      "Check a diagram (wires, loops, stability, overloads, scaling, by a trial run) or a mechanism");
  verb->add_option("FILE", request->file, "diagram or mechanism file")->required();
  verb->add_flag("--json", request->json, "print JSON instead of the tables (its keys: docs/check.md)");
  verb->add_flag("--rescale", request->rescale, "write the diagram in scaled signals to the file of -o");
  verb->add_option("-o,--output", request->output, "with --rescale: write NEW.toml")->type_name("NEW");
  choose(verb, chosen, request, check_file);
}

void add_solve(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<SolveRequest>();
  CLI::App* const verb = app.add_subcommand("solve", "Solve a mechanism exactly: its motion over one turn");
  verb->add_option("MECHANISM", request->mechanism, "mechanism file (oblique-mechanism/1)")->required();
  verb->add_option("--positions", request->positions, "rows over the turn, both ends included")
      ->capture_default_str()
      ->check(CLI::Range(2, 10'000'000));
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

template <class Request>
void add_method(CLI::App* verb, Request& request) {
  verb->add_option("--method", request.method,
                   "triangles: servo-tracked oblique triangles; gradient: integrators that descend, for any "
                   "group; paper: "
                   "a class III group as its source draws it")
      ->type_name("triangles|gradient|paper")
      ->capture_default_str();
}

void add_patch(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<PatchRequest>();
  CLI::App* const verb = app.add_subcommand("patch", "Patch a mechanism: the diagram that simulates it");
  verb->add_option("MECHANISM", request->mechanism, "mechanism file (oblique-mechanism/1)")->required();
  verb->add_option("--gain", request->gain, "gain of the servo amplifiers; inf: ideal")
      ->capture_default_str();
  verb->add_option("--bandwidth", request->bandwidth,
                   "bandwidth of the servo amplifiers, in Hz or with a unit; inf: algebraic loops "
                   "(default: 100 times the crank's frequency)");
  add_method(verb, *request);
  verb->add_flag("--derivatives", request->derivatives,
                 "velocities and accelerations too, as further circuits");
  verb->add_option(
          "--split", request->split,
          "how to take a triad apart: the lead whose triangle carries the variable length, the lead that "
          "closes the loop, the third (default: the split that is worth the most)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LEAD,LEAD,LEAD");
  verb->add_option("--slower", request->slower, "how many times slower the outer loop of a triad is")
      ->capture_default_str();
  verb->add_option("--unit", request->unit,
                   "1 machine unit of the coordinates, for example \"2.5 m\" (default: by the exact motion)")
      ->type_name("LENGTH");
  verb->add_flag("--force", request->force,
                 "patch it even where it is unstable, flips on the way, or needs a kind of element that the "
                 "machine has not");
  verb->add_option("-o,--output", request->output, "write the diagram to FILE.toml")->type_name("FILE");
  verb->add_option(
          "--machine", request->machine,
          "write it in the elements of this machine, with a bill of what it needs and what is missing")
      ->type_name("NAME");
  verb->add_option("--sheets", request->sheets,
                   "with --machine: write PREFIX-patch.csv (connections), PREFIX-pots.csv (settings), "
                   "PREFIX-static.csv (static test), and PREFIX.txt with all three for paper")
      ->type_name("PREFIX");
  choose(verb, chosen, request, patch_mechanism);
}

void add_compare(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<CompareRequest>();
  CLI::App* const verb =
      app.add_subcommand("compare", "Compare the patched mechanism with its exact motion, gain by gain");
  verb->add_option("MECHANISM", request->mechanism, "mechanism file (oblique-mechanism/1)")->required();
  verb->add_option("--gain", request->gains, "gains of the servo amplifiers (default 1e2,1e3,1e4,1e5,1e6)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("G,G,…");
  verb->add_option("--bandwidth", request->bandwidths,
                   "bandwidths of the servo amplifiers, in Hz or with a unit; each is run with each gain "
                   "(default: 100 times the crank's frequency)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("B,B,…");
  verb->add_option("--method", request->methods,
                   "of triangles, gradient and paper those to hold against each other, as `patch` has them "
                   "(default triangles)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("M,M,…");
  verb->add_option(
          "--machine", request->machine,
          "run it in this machine's elements too, and say what each published figure adds to the error "
          "(oblique machines lists them); one gain (default 1e6)")
      ->type_name("NAME");
  CLI::Option* const monte_carlo =
      verb->add_option("--monte-carlo", request->runs,
                       "run it N times more, each with tolerances drawn anew; one gain (default 1e6)")
          ->type_name("N")
          ->check(CLI::Range(1, 10'000'000));
  verb->add_option("--tolerance", request->tolerance,
                   "how far the weights of summers and integrators and the errors of multipliers scatter, "
                   "uniformly on both sides, for example 0.1% (default with --machine: as its profile says)")
      ->type_name("X")
      ->needs(monte_carlo);
  verb->add_option("--seed", request->seed, "chooses the draws")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber)
      ->needs(monte_carlo);
  verb->add_option("--first-run", request->first_run,
                   "number of the first run; with --monte-carlo 1 it repeats one")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber)
      ->needs(monte_carlo);
  verb->add_option("--threads", request->threads,
                   "runs at a time, which changes no result (default: what the processor has)")
      ->type_name("T")
      ->check(CLI::Range(1, 1024))
      ->needs(monte_carlo);
  verb->add_flag("--json", request->json, "print JSON instead of the table");
  verb->add_option("-o,--output", request->output, "write the JSON to FILE.json")->type_name("FILE");
  choose(verb, chosen, request, compare_mechanism);
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
      ->type_name("NAME,…");
  verb->add_option("--starts", request->starts,
                   "searches begun, spread over the bounds; 1: from the file only")
      ->capture_default_str()
      ->check(CLI::Range(1, 10'000));
  verb->add_option("-o,--output", request->output, "write the fitted mechanism to NEW.toml")
      ->type_name("NEW");
  choose(verb, chosen, request, fit_mechanism);
}

void add_blocks(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<BlocksRequest>();
  CLI::App* const verb = app.add_subcommand("blocks", "List the blocks, or tell all about one");
  verb->add_option("NAME", request->name, "block to tell about");
  choose(verb, chosen, request, show_blocks);
}

void add_machines(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<MachinesRequest>();
  CLI::App* const verb =
      app.add_subcommand("machines", "List the machines a diagram can be for, or tell all about one");
  verb->add_option("NAME", request->name, "machine to tell about");
  verb->add_flag("--json", request->json, "print JSON instead of the tables (its keys: docs/machines.md)");
  choose(verb, chosen, request, show_machines);
}

}  // namespace

std::optional<ExitStatus> parse_arguments(int argc, char** argv, Chosen& chosen) {
  CLI::App app(kIntroduction, "oblique");
  app.footer(kEpilogue);
  app.set_version_flag("--version", std::string("oblique ") + OBLIQUE_VERSION);
  app.add_option("--blocks", chosen.session.block_directories,
                 "folder with further blocks (*.toml); may be repeated")
      ->type_name("DIR")
      ->allow_extra_args(false);
  app.require_subcommand(1);
  app.fallthrough();
  add_run(app, chosen);
  add_check(app, chosen);
  add_solve(app, chosen);
  add_modes(app, chosen);
  add_patch(app, chosen);
  add_compare(app, chosen);
  add_fit(app, chosen);
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
    print_error(to_string(explain(app, error, std::vector<std::string>(argv + 1, argv + argc))));
    return ExitStatus::bad_request;
  }
  return std::nullopt;
}

}  // namespace oblique::cli
