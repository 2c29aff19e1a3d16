// SPDX-License-Identifier: MIT
// The verbs for diagrams and what they are made of.
#include "verbs/verbs.h"

namespace oblique::cli {

void add_run(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<RunRequest>();
  CLI::App* const verb = app.add_subcommand("run", "Run a diagram: its outputs over time");
  verb->add_option("DIAGRAM", request->diagram, "diagram file (oblique-diagram/1)")->required();
  add_table_options(verb, *request);
  add_plot_option(verb, *request, "draw the curves of all columns, or of those of --columns");
  verb->add_option("--against", request->against,
                   "with --plot: draw against this column in place of t, as a machine's plotter does")
      ->type_name("NAME");
  verb->add_option("--until", request->until, "end of the run, for example 2*pi or \"500 ms\"")
      ->type_name("T");
  verb->add_option("--set", request->settings, "change a parameter: block.parameter=value; may be repeated")
      ->type_name("SETTING")
      ->allow_extra_args(false);
  verb->add_option("--step", request->step,
                   "set what this step of the diagram's lesson sets; with --check, hold what it says is seen")
      ->type_name("N");
  verb->add_option(
          "--vary", request->vary,
          "run with each of these values of a parameter or a weight, and give a family of curves: "
          "c.gain=1e2,1e3,1e4 or x.in[1]=0.1..1:10; --columns then names outputs, each with all values")
      ->type_name("NAME=VALUES");
  verb->add_option("--from", request->from,
                   "go on from the state that an earlier run saved; --until is then later")
      ->type_name("STATE");
  verb->add_option("--save", request->save,
                   "save the state at the end, or where Ctrl-C interrupts the run, to STATE.toml")
      ->type_name("STATE");
  verb->add_flag("--events", request->events, "list what switched, and when");
  verb->add_flag(
      "--check", request->check,
      "hold the run against the diagram's [expect] and [published], or against the lesson's question "
      "where --set answers it; status 1 where it fails");
  verb->add_flag(
      "--static-test", request->static_test,
      "print every element's output and every integrator's input in initial condition; nothing is run");
  verb->add_flag("--halt-on-overload", request->halt_on_overload,
                 "end the run with status 1 where a signal first leaves ±1 machine unit");
  verb->add_flag(
      "--trust", request->trust,
      "run again, finer and by another method, and say how many digits of each output can be trusted");
  verb->add_option("--sensitivity", request->sensitivity,
                   "add columns with the derivatives of the outputs by these parameters: c.gain,x.in[1]")
      ->type_name("NAMES")
      ->delimiter(',');
  choose(verb, chosen, request, run_diagram);
}

void add_operate(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<OperateRequest>();
  CLI::App* const verb = app.add_subcommand(
      "operate", "Hold a diagram as a machine: modes, pots, a voltmeter and a scope, by commands on stdin");
  verb->add_option("DIAGRAM", request->diagram, "diagram file (oblique-diagram/1)")->required();
  verb->footer("The command `help` lists the commands; docs/operating.md shows them.");
  choose(verb, chosen, request, operate);
}

void add_check(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<CheckRequest>();
  CLI::App* const verb = app.add_subcommand(
      "check",
      "Check a diagram (wires, loops, stability, overloads, scaling, by a trial run) or a mechanism");
  verb->add_option("FILE", request->file, "diagram or mechanism file")->required();
  verb->add_flag("--json", request->json, "print JSON instead of the tables (its keys: docs/check.md)");
  add_plot_option(verb, *request, "draw the eigenvalues of a diagram along its run in the complex plane");
  verb->add_flag("--rescale", request->rescale, "write the diagram in scaled signals to the file of -o");
  verb->add_option("-o,--output", request->output, "with --rescale: write NEW.toml")->type_name("NEW");
  choose(verb, chosen, request, check_file);
}

void add_atlas(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<AtlasRequest>();
  CLI::App* const verb = app.add_subcommand("atlas",
                                            "Run published programmes again: a table of what was published "
                                            "against what is computed; status 1 where "
                                            "a difference is not explained");
  verb->add_option("FOLDER", request->folder, "folder with diagrams that have [published]")->required();
  verb->add_option("-o,--output", request->output,
                   "write an index and a page for each programme to this folder")
      ->type_name("SITE");
  verb->add_option("--studio", request->studio, "with -o: lead from the pages to this page of the studio")
      ->type_name("PAGE");
  verb->add_option("--theme", request->theme,
                   "auto: light or dark as the reader's screen; on paper always light")
      ->capture_default_str()
      ->type_name("auto|light|dark");
  choose(verb, chosen, request, run_atlas);
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

}  // namespace oblique::cli
