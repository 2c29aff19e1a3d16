// SPDX-License-Identifier: MIT
#include <oblique/report/mechanism_report.h>

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include <oblique/compare/compare.h>
#include <oblique/draw/chart/chart.h>
#include <oblique/draw/schematic/diagram_drawing.h>
#include <oblique/machine/sheets.h>
#include <oblique/solve/solve_error.h>
#include <oblique/solve/stability/analysis.h>

#include <oblique/diagram/flatten.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/comparison_chart.h>
#include <oblique/report/comparison_report.h>
#include <oblique/report/component_list_text.h>
#include <oblique/report/judgement_text.h>
#include <oblique/report/linkage_scene.h>
#include <oblique/report/mechanism_check_tables.h>
#include <oblique/report/page_text.h>
#include <oblique/report/pole_chart.h>

namespace oblique::report {
namespace {

constexpr double kPageWidth = 860;  // of pictures that may be as wide as the page [px]

class Writer {
 public:
  explicit Writer(const MechanismReport& report)
      : report_(report),
        mechanism_(report.mechanism),
        page_(mechanism_.title.empty() ? mechanism_.file : mechanism_.title) {}

  HtmlPage write() {
    drawing();
    structure();
    motion();
    try {
      patched_ = commission::judged_patch(mechanism_, report_.blocks, report_.options);
    } catch (const text::Error& error) {
      page_.heading("Patch");
      page_.paragraph("There is no patch of this mechanism. " +
                      capitalised(words_of(error, report_.vocabulary)));
      return std::move(page_);
    }
    patch();
    convergence();
    stability();
    if (report_.machine != nullptr) machine(*report_.machine);
    return std::move(page_);
  }

 private:
  /// The mechanism at its start, with the paths that are worth a look.
  void drawing() {
    page_.heading("The mechanism");
    page_.introduction(fmt::format("{}, {}, drawn to scale at the start of the motion. File: {}.{}",
                                   count(mechanism_.bodies.size(), "body", "bodies"),
                                   count(mechanism_.drives.size(), "drive", "drives"), mechanism_.file,
                                   mechanism_.source.empty() ? "" : " Source: " + mechanism_.source + "."));
    mechanism::Mechanism untitled = mechanism_;
    untitled.title.clear();  // the page has it
    draw::LinkageScene scene = linkage_scene(untitled, 0, 1).scene;
    if (!scene.motion.empty()) scene.traces = draw::points_to_trace(mechanism_);
    page_.picture(draw::draw_linkage(untitled, scene));
  }

  /// Groups, and what `check` tells of them.
  void structure() {
    const MechanismCheck check = examine(mechanism_, mechanism_.file);
    page_.heading("Structure");
    page_.introduction(
        fmt::format("Mobility {}: so many drives it takes. A mechanism consists of its drives and of groups "
                    "that add none; each group can be solved by itself, in this order:",
                    check.analysis.mobility.gruebler));
    std::vector<std::string> groups;
    for (const mechanism::Group& group : check.structure.groups)
      groups.push_back(describe(mechanism_, group));
    page_.list(groups);
    if (check.finding)
      page_.paragraph(fmt::format("What keeps it from moving all the way: {}.", *check.finding));
    for (const CheckTable& table : tables_of(check)) {
      page_.subheading(table.title);
      page_.introduction(table.explanation);
      page_.table(table.table.rows());
    }
    if (!check.analysis.motion_range) return;
    const std::vector<std::string> found = remarks(check);
    if (found.empty()) return;
    page_.subheading("What a designer would look at again");
    page_.list(found);
  }

  /// A point of the coupler, or the first one that moves.
  void motion() {
    if (mechanism_.drives.empty()) return;
    std::vector<std::size_t> points = draw::points_to_trace(mechanism_);
    for (std::size_t p = 0; points.empty() && p < mechanism_.points.size(); ++p) {
      if (!mechanism_.points[p].fixed && !mechanism_.bodies_at(p).empty()) points.push_back(p);
    }
    if (points.empty()) return;
    page_.heading("Motion");
    const std::string& name = mechanism_.points[points.front()].name;
    page_.introduction(
        fmt::format("Where point {} is, how fast it moves, and how its velocity changes, over {}: exact, "
                    "from the geometry.",
                    name, mechanism_.drives.front().name));
    draw::Chart plots = draw::point_plots(point_history(mechanism_, name));
    plots.title.clear();
    plots.width = kPageWidth;
    page_.picture(draw::draw_chart(plots));
  }

  void patch() {
    const diagram::Diagram& diagram = patched_.diagram;
    page_.heading("Patch");
    page_.paragraph(
        "The patch is the diagram that makes an analog computer move as the mechanism does: servo amplifiers "
        "drive the unknowns of each group until its triangles close.");
    std::string comment = diagram.comment;  // its lines are broken where a file's are
    std::replace(comment.begin(), comment.end(), '\n', ' ');
    if (!comment.empty()) page_.paragraph(comment);
    page_.paragraph("Judged before it runs: " + judgement_text(patched_.judgement, report_.vocabulary));
    page_.picture(draw::draw_diagram(diagram, report_.blocks));
    std::map<std::string, std::size_t> counts;
    for (const diagram::BlockInstance& block : diagram.blocks) ++counts[block.type];
    std::vector<std::vector<std::string>> rows;
    rows.reserve(counts.size() + 1);
    for (const auto& [type, n] : counts) rows.push_back({type, std::to_string(n)});
    rows.push_back({"in all", std::to_string(diagram.blocks.size())});
    page_.introduction("Its blocks:");
    page_.table({"block", "count"}, rows);
  }

  void convergence() {
    page_.heading("Convergence");
    page_.paragraph(
        "The patch runs over the motion with servo amplifiers of each gain; its moving points are held "
        "against "
        "the exact motion. The error falls as the gain grows.");
    compare::CompareOptions sweep;
    sweep.methods = {report_.options.method};
    if (report_.options.bandwidth) sweep.bandwidths = {*report_.options.bandwidth};
    sweep.progress = report_.progress;
    try {
      errors_of(compare::compare(mechanism_, report_.blocks, sweep));
    } catch (const solve::SolveError& error) {
      page_.paragraph("A run fails: " + words_of(error, report_.vocabulary));
    }
  }

  void errors_of(const compare::Comparison& comparison) {
    const std::string unit = " [" + comparison.unit + "]";
    std::vector<std::vector<std::string>> rows;
    for (const compare::ComparedRun& run : comparison.runs) {
      const auto part = [&](double compare::ErrorParts::*which) {
        return run.parts ? readable(*run.parts.*which) : std::string("unknown");
      };
      rows.push_back({readable(run.gain), readable(run.max_error), readable(run.max_error / comparison.size),
                      readable(run.rms_error), run.worst.point, drive_text(comparison, run.worst.drive),
                      part(&compare::ErrorParts::at_rest), part(&compare::ErrorParts::lag),
                      part(&compare::ErrorParts::solver), run.stable ? "yes" : "NO"});
    }
    page_.introduction(
        "Largest error of any point, also as a part of the largest link; root mean square of all errors; the "
        "point that errs most, and where the drive then stands. Static is what the finite gain leaves at "
        "rest, "
        "lag what the loops are behind for their speed, solver what the tolerance of the run leaves.");
    page_.table({"gain", "largest error" + unit, "of the largest link", "r.m.s." + unit, "worst", "at",
                 "static" + unit, "lag" + unit, "solver" + unit, "stable"},
                rows);
    const compare::GainSeries& series = comparison.series.front();
    page_.introduction(series.order
                           ? fmt::format("The error falls with the gain to the power {}; −1 is what "
                                         "amplifiers of finite gain should give.",
                                         readable(*series.order))
                           : "No order of convergence: it takes two gains whose errors stand clear of "
                             "the tolerance.");
    draw::Chart chart = chart_of(comparison);
    chart.title.clear();  // the heading tells it
    page_.picture(draw::draw_chart(chart));
  }

  void stability() {
    const diagram::FlatDiagram flat = diagram::flatten(patched_.diagram, report_.blocks);
    const network::Program program(network::assemble(flat));
    const solve::Analysis analysis =
        solve::analyse(program, flat, oblique::solve::options_of(patched_.diagram.run));
    const solve::StabilityReport& found = analysis.stability;
    page_.heading("Stability");
    page_.introduction(fmt::format(
        "The eigenvalues of the patch, linearised at {} of its motion: one with a positive real part grows. "
        "The servo loops have to be much faster than the problem that they solve; a damping ratio of 1 or "
        "more "
        "means that they do not overshoot.",
        count(found.instants, "moment", "moments")));
    std::vector<std::vector<std::string>> rows;
    const auto tell = [&](const char* whose, const std::optional<solve::WorstMode>& worst) {
      if (!worst) return;
      rows.push_back({whose, readable(worst->mode.damping_ratio()), readable(worst->mode.natural_frequency()),
                      readable(worst->mode.pole.real()), readable(worst->time)});
    };
    tell("servo loops, least damped", found.servo_mode);
    tell("servo loops, slowest", found.slowest_servo);
    tell("the problem itself, least damped", found.problem_mode);
    if (!rows.empty())
      page_.table({"mode", "damping ratio", "natural frequency [rad/s]", "real part [1/s]", "at t [s]"},
                  rows);
    if (found.grows_from)
      page_.paragraph(fmt::format("A servo loop grows from t = {} s on.", readable(*found.grows_from)));
    if (analysis.failure)
      page_.paragraph("The run fails: " + words_of(solve::SolveError(*analysis.failure), report_.vocabulary));
    for (const std::string& what : found.left_out) page_.paragraph("Left out: " + what + ".");
    const draw::Chart poles = pole_chart(flat, program, analysis.instants, "");
    page_.picture(draw::draw_chart(poles));
  }

  void machine(const diagram::MachineProfile& profile) {
    page_.heading("On the " + profile.title);
    commission::MachinePatch patch;
    try {
      patch = commission::put_on_machine(mechanism_, report_.blocks, profile, patched_);
    } catch (const text::Error& error) {
      page_.paragraph("It does not run there. " + capitalised(words_of(error, report_.vocabulary)));
      return;
    }
    const diagram::Diagram& diagram = patch.realised;
    const diagram::FlatDiagram flat = diagram::flatten(diagram, report_.blocks);
    const machine::ComponentList components = machine::component_list_of(flat, profile);
    page_.introduction(
        "The same patch in this machine's own elements. What it takes of them, and what there is:");
    page_.table(component_list_table(components).rows());
    page_.paragraph(capitalised(verdict_text(components)) + ".");
    if (const std::string text = bandwidth_text(patch, profile); !text.empty())
      page_.paragraph(capitalised(text));
    page_.paragraph("Judged on these elements: " + judgement_text(patch.judgement, report_.vocabulary));
    const machine::MachineSheets sheets = machine::sheets_of(diagram, flat, report_.blocks, profile);
    const auto add = [&](const machine::Sheet& sheet, const char* explanation) {
      page_.subheading("Sheet: " + sheet.title);
      page_.introduction(explanation);
      page_.table(sheet.columns, sheet.rows);
    };
    add(sheets.potentiometers, "To what each potentiometer is set, and between which elements it stands.");
    add(sheets.connections, "Every cord of the patch: from an output to an input with its weight.");
    add(sheets.static_test,
        "What each output shows, and how fast each integrator begins to run, before the clock starts: the "
        "test "
        "that all is patched as it should be.");
  }

  const MechanismReport& report_;
  const mechanism::Mechanism& mechanism_;
  commission::JudgedPatch patched_;
  HtmlPage page_;
};

}  // namespace

HtmlPage MechanismReport::page() const {
  return Writer(*this).write();
}

}  // namespace oblique::report
