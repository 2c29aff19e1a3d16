// SPDX-License-Identifier: MIT
// The page that tells all about a mechanism and its patch.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <oblique/compare/compare.h>
#include <oblique/compare/judge.h>
#include <oblique/draw/chart.h>
#include <oblique/machine/realise.h>
#include <oblique/mechanism/read_mechanism.h>
#include <oblique/solve/analysis.h>

#include "command.h"
#include "comparison_chart.h"
#include "comparison_output.h"
#include "html_page.h"
#include "linkage_scene.h"
#include "machine_patch.h"
#include "mechanism_check.h"
#include "patch_choice.h"
#include "pole_chart.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

std::string scientific(double value) {
  return fmt::format("{:.3e}", value);
}

class MechanismReport {
 public:
  MechanismReport(const Mechanism& mechanism, const BlockLibrary& library, const PatchOptions& options)
      : mechanism_(mechanism),
        library_(library),
        patched_(judged_patch(mechanism, library, options)),
        page_(mechanism.title.empty() ? mechanism.file : mechanism.title) {
    page_.paragraph(mechanism.source.empty()
                        ? fmt::format("Mechanism: {}", mechanism.file)
                        : fmt::format("Mechanism: {}. Source: {}", mechanism.file, mechanism.source));
  }

  /// The mechanism at its start, with the paths that are worth a look.
  void drawing() {
    LinkageScene scene = linkage_scene(mechanism_, "", 1).scene;
    scene.traces = points_to_trace(mechanism_);
    page_.picture(draw_linkage(mechanism_, scene));
  }

  /// Groups, and what `check` tells of them.
  void structure() {
    const MechanismCheck check = examine(mechanism_, mechanism_.file);
    page_.heading("Structure");
    page_.paragraph(fmt::format("{}, mobility {}, {}.", count(mechanism_.bodies.size(), "body", "bodies"),
                                check.analysis.mobility.gruebler,
                                count(mechanism_.drives.size(), "drive", "drives")));
    std::vector<std::string> groups;
    for (const Group& group : check.structure.groups) groups.push_back(describe(mechanism_, group));
    page_.list(groups);
    if (check.finding) page_.paragraph(fmt::format("It does not turn fully: {}.", *check.finding));
    const std::string text = to_text(check);
    const std::size_t tables = text.find("\n\n");  // behind the groups, which stand above
    if (tables != std::string::npos) page_.preformatted(text.substr(tables + 2));
  }

  void patch() {
    const Diagram& diagram = patched_.diagram;
    page_.heading("Patch");
    std::string comment = diagram.comment;  // its lines are broken where a file's are
    std::replace(comment.begin(), comment.end(), '\n', ' ');
    if (!comment.empty()) page_.paragraph(comment);
    std::map<std::string, std::size_t> counts;
    for (const BlockInstance& block : diagram.blocks) ++counts[block.type];
    std::vector<std::vector<std::string>> rows;
    for (const auto& [type, n] : counts) rows.push_back({type, std::to_string(n)});
    rows.push_back({"in all", std::to_string(diagram.blocks.size())});
    page_.table({"block", "count"}, rows);
    page_.paragraph("Judged before it runs: " + judgement_text(patched_.judgement));
  }

  void convergence(const Comparison& comparison) {
    page_.heading("Convergence");
    page_.paragraph(
        "The patch runs over one turn with servo amplifiers of each gain; its moving points are held against "
        "the exact motion. Static is what the finite gain leaves at rest, lag what the loops are behind for "
        "their speed, solver what the tolerance of the run leaves.");
    const std::string unit = " [" + comparison.unit + "]";
    std::vector<std::vector<std::string>> rows;
    for (const ComparedRun& run : comparison.runs) {
      const auto part = [&](double ErrorParts::*which) {
        return run.parts ? scientific(*run.parts.*which) : std::string("unknown");
      };
      rows.push_back({short_number(run.gain), scientific(run.max_error),
                      scientific(run.max_error / comparison.size), scientific(run.rms_error), run.worst.point,
                      drive_text(comparison, run.worst.drive), part(&ErrorParts::at_rest),
                      part(&ErrorParts::lag), part(&ErrorParts::solver), run.stable ? "yes" : "NO"});
    }
    page_.table({"gain", "max error" + unit, "of the largest link", "rms" + unit, "worst", "at", "static",
                 "lag", "solver", "stable"},
                rows);
    const GainSeries& series = comparison.series.front();
    page_.paragraph(series.order
                        ? fmt::format("The error falls with the gain to the power {:.3f}.", *series.order)
                        : "No order: it takes two gains whose errors stand clear of the tolerance.");
    Chart chart = chart_of(comparison);
    chart.title.clear();  // the heading tells it
    page_.picture(draw_chart(chart));
  }

  void stability() {
    const FlatDiagram flat = flatten(patched_.diagram, library_);
    const Program program(assemble(flat));
    const Analysis analysis = analyse(program, flat, oblique::options_of(patched_.diagram.run));
    const StabilityReport& found = analysis.stability;
    page_.heading("Stability");
    std::vector<std::string> items;
    const auto tell = [&](const char* whose, const std::optional<WorstMode>& worst) {
      if (!worst) return;
      items.push_back(fmt::format("{}: damping ratio {:.3g}, natural frequency {:.3g} rad/s at t = {:.3g} s",
                                  whose, worst->mode.damping_ratio(), worst->mode.natural_frequency(),
                                  worst->time));
    };
    tell("the servo loops' least damped mode", found.servo_mode);
    tell("the problem's least damped mode", found.problem_mode);
    if (found.slowest_servo) {
      items.push_back(fmt::format("the servo loops' slowest pole: {:.3g} 1/s at t = {:.3g} s",
                                  found.slowest_servo->mode.pole.real(), found.slowest_servo->time));
    }
    if (found.grows_from)
      items.push_back(fmt::format("a servo loop grows from t = {:.3g} s on", *found.grows_from));
    for (const std::string& what : found.left_out) items.push_back("left out: " + what);
    page_.paragraph(fmt::format("Eigenvalues of the linearised patch at {} of its motion.",
                                count(found.instants, "moment", "moments")));
    page_.list(items);
    Chart poles = pole_chart(program, analysis.instants, "");
    if (!poles.panels.empty()) page_.picture(draw_chart(poles));
  }

  void machine(const MachineProfile& profile) {
    const Diagram diagram = realise(patched_.diagram, library_, profile).diagram;
    const FlatDiagram flat = flatten(diagram, library_);
    page_.heading("On the " + profile.title);
    page_.preformatted(to_text(bill_of(flat, profile)));
    const MachineSheets sheets = sheets_of(diagram, flat, library_, profile);
    for (const Sheet* sheet : {&sheets.potentiometers, &sheets.connections, &sheets.static_test}) {
      page_.subheading("Sheet: " + sheet->title);
      page_.table(sheet->columns, sheet->rows);
    }
  }

  std::string text() const { return page_.text(); }

 private:
  const Mechanism& mechanism_;
  const BlockLibrary& library_;
  JudgedPatch patched_;
  HtmlPage page_;
};

}  // namespace

ExitStatus report_mechanism(const Session& session, const ReportRequest& request) {
  check_output(request.output, ".html");
  check_not_input(request.output, request.mechanism, "mechanism");
  const MachineProfile* const machine = request.machine.empty() ? nullptr : find_machine(request.machine);
  if (machine == nullptr && !request.machine.empty()) throw ReadError(unknown_machine(request.machine));
  const PatchOptions options = patch_options(request.patch);
  CompareOptions sweep;
  sweep.methods = {options.method};
  if (options.bandwidth) sweep.bandwidths = {*options.bandwidth};

  const BlockLibrary library = session.blocks();
  const Mechanism mechanism = read_mechanism(request.mechanism);
  MechanismReport report(mechanism, library, options);
  report.drawing();
  report.structure();
  report.patch();
  {
    Progress progress("comparing");
    sweep.progress = [&](double fraction) { progress.show(fraction); };
    report.convergence(compare(mechanism, library, sweep));
  }
  report.stability();
  if (machine != nullptr) report.machine(*machine);
  save(request.output, report.text());
  return ExitStatus::done;
}

}  // namespace oblique::cli
