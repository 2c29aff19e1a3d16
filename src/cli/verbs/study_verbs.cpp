// SPDX-License-Identifier: MIT
// The verbs for many machines at once.
#include "verbs/verbs.h"

namespace oblique::cli {

void add_sweep(CLI::App& app, Chosen& chosen) {
  auto request = std::make_shared<SweepRequest>();
  CLI::App* const verb = app.add_subcommand(
      "sweep", "Run a diagram or a mechanism many times with other values, and measure it");
  verb->add_option("FILE", request->file, "diagram or mechanism file")->required();
  verb->add_option("--vary", request->vary,
                   "values of a parameter (c.gain), a weight (x.in[2]), a dimension of a mechanism: 1,2,5 or "
                   "0.8..1.2:9 or 1e2..1e6:5:log; may be repeated, all combinations are run")
      ->type_name("NAME=VALUES")
      ->allow_extra_args(false);
  verb->add_option(
          "--measure", request->measures,
          "a number of each run: max min mean rms end start integral of outputs and signals, time of "
          "a condition, such as 'max(abs(side - exact))' or 'rise = time(x > 0.9)'; may be repeated "
          "(default: end of every output)")
      ->type_name("EXPRESSION")
      ->allow_extra_args(false);
  verb->add_option(
          "--scatter", request->scatter,
          "draw this parameter of all blocks of a type anew for each machine, uniformly from X below what it "
          "is to X above; X is in its unit (1% is 0.01, not a part of the value); may be repeated")
      ->type_name("TYPE.PARAMETER=X")
      ->allow_extra_args(false);
  verb->add_option("--tolerance-of-elements", request->tolerance_of_elements,
                   "draw the weights of summers and integrators and the errors of multipliers, for example "
                   "within 0.1%")
      ->type_name("X");
  verb->add_option("--machine", request->machine, "draw the elements as those of this machine scatter")
      ->type_name("NAME");
  verb->add_option("--runs", request->runs,
                   "with --latin or --sobol: so many machines; where elements scatter: so many for each "
                   "combination")
      ->type_name("N")
      ->check(whole_number(1, 1'000'000'000));
  verb->add_flag("--latin", request->latin, "choose the values by a Latin hypercube between their bounds");
  verb->add_flag("--sobol", request->sobol, "choose the values by a Sobol sequence between their bounds");
  verb->add_option("--seed", request->seed, "chooses the random numbers")
      ->capture_default_str()
      ->check(whole_number(0, kAnyNumber));
  verb->add_option("--gain", request->gain, "of a mechanism: gain of its servo amplifiers (default 1e6)");
  verb->add_option("--method", request->method, "of a mechanism: how it is patched (default triangles)")
      ->type_name("triangles|gradient|paper");
  verb->add_option("--tolerance", request->tolerance, "relative, of each run (default: that of the file)")
      ->type_name("X");
  verb->add_option("--samples", request->samples,
                   "rows of each run, from which the measures are taken (default: those of the file)")
      ->type_name("N");
  verb->add_option("--jobs", request->jobs,
                   "machines at a time, which changes no result (default: what the processor has)")
      ->type_name("T")
      ->check(whole_number(1, 1024));
  verb->add_option(
          "-o,--output", request->output,
          "write a row a machine, the varied values first, to TABLE, which ends in .csv, .npy, .mat or "
          ".json")
      ->type_name("TABLE");
  verb->add_option("--plan", request->plan,
                   "write all this as a plan to PLAN.toml, for `oblique ensemble`; without -o and --plot "
                   "nothing is run")
      ->type_name("PLAN");
  add_plot_option(verb, *request,
                  "draw the measures: curves over one varied name, a map over two, the effects of more, a "
                  "histogram of what scatters");
  choose(verb, chosen, request, sweep);
}

}  // namespace oblique::cli
