// SPDX-License-Identifier: MIT
#include <oblique/synthesis/fit.h>

#include <fmt/format.h>

#include <oblique/mechanism/model/read_mechanism.h>

#include <oblique/report/text_table.h>
#include <oblique/text/file.h>
#include "terminal/output_files.h"
#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {
namespace {

std::string table_of_errors(const synthesis::Fit& fit, const std::string& unit) {
  report::Table table({fmt::format("distance [{}]", unit), "before", "after"});
  table.add({"root mean square", report::short_number(fit.before.rms), report::short_number(fit.after.rms)});
  table.add({"largest", report::short_number(fit.before.largest), report::short_number(fit.after.largest)});
  return table.text(1);
}

std::string table_of_dimensions(const synthesis::Fit& fit, const std::string& unit) {
  report::Table table({fmt::format("dimension [{}]", unit), "old", "new", "lower bound", "upper bound", ""});
  for (const synthesis::FittedDimension& d : fit.dimensions) {
    std::string remark = d.changed() ? "" : "unchanged";
    if (d.after < d.lower || d.after > d.upper) {  // as given
      remark += ", outside its bounds";
    } else if (d.at_bound()) {
      remark += fmt::format("{}at its {} bound", remark.empty() ? "" : ", ",
                            d.after <= d.lower ? "lower" : "upper");
    }
    table.add({d.name, report::short_number(d.before), report::short_number(d.after),
               report::short_number(d.lower), report::short_number(d.upper), remark});
  }
  return table.text(1);
}

std::string report(const synthesis::Fit& fit, const mechanism::Mechanism& mechanism,
                   const synthesis::TargetPath& target) {
  const std::string& unit = mechanism.length_unit;
  std::string text = fmt::format("{}\npath of {}: {} points of {}, {}; {} tried\n\n", mechanism.title,
                                 mechanism.points[target.point].name, target.positions.size(), target.file,
                                 target.timing.empty() ? "each to the nearest place of the path"
                                                       : fmt::format("each at its '{}'", target.timing),
                                 report::count(fit.mechanisms_tried, "mechanism", "mechanisms"));
  text += table_of_errors(fit, unit) + "\n" + table_of_dimensions(fit, unit) + "\n";
  if (!fit.improved) return text + "no mechanism within the bounds comes nearer than the given one\n";
  text +=
      fit.turns_fully
          ? fmt::format(
                "it turns fully, as before; its links accelerate by up to {:.3g} ω² (before {:.3g} ω²), ω "
                "the speed of the drive\n",
                fit.acceleration_after, fit.acceleration_before)
          : "it does not turn fully, nor did it before\n";
  if (fit.sketch_moved) text += "[sketch] was moved along: the old one would pick another assembly mode\n";
  return text;
}

}  // namespace

ExitStatus fit_mechanism(const Session&, const FitRequest& request) {
  if (!request.output.empty()) {
    check_output(request.output, ".toml");
  }
  const std::string text = text::read_file(request.mechanism);
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, request.mechanism);
  const synthesis::TargetPath target =
      synthesis::read_target_path(text::read_file(request.path), request.path, mechanism);
  synthesis::FitOptions options;
  options.starts = request.starts;
  synthesis::Fit fit;
  {
    Progress progress("fitting");
    options.progress = [&](double fraction) { progress.show(fraction); };
    fit = synthesis::fit_path(text, request.mechanism, request.free, target, options);
  }
  print(report(fit, mechanism, target));
  if (!fit.improved) {
    if (!request.output.empty()) note(fmt::format("{} is not written\n", request.output));
    return ExitStatus::no;
  }
  if (!request.output.empty()) save(request.output, fit.text);
  return ExitStatus::done;
}

}  // namespace oblique::cli
