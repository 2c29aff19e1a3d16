// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/diagram_report.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include <oblique/diagram/flatten.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/diagram/published.h>
#include <oblique/draw/schematic/diagram_drawing.h>
#include <oblique/machine/component_list.h>
#include <oblique/machine/role.h>
#include <oblique/machine/scaled_realisation.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/atlas/equations.h>
#include <oblique/report/atlas/ideal_amplifiers.h>
#include <oblique/report/component_list_text.h>
#include <oblique/report/diagram_check.h>
#include <oblique/report/diagram_check_text.h>
#include <oblique/report/page_text.h>
#include <oblique/report/pole_chart.h>
#include <oblique/report/run_chart.h>
#include <oblique/solve/static_test.h>

namespace oblique::report {
namespace {

constexpr double kBroadPage = 860;  // of pictures that may be as wide as the page [px]

bool is_top_level(const std::string& path) {
  return path.find('.') == std::string::npos;
}

std::string printed(const RecoveredEquation& equation) {
  std::string left = equation.left;
  if (left.starts_with("der(")) left = derivative_of(left.substr(4, left.size() - 5));
  std::string text = left + " = " + printed_expression(equation.right);
  if (!equation.start.empty()) text += ",   starting from " + printed_expression(equation.start);
  if (!equation.unknown.empty()) text += ",   solved for " + equation.unknown;
  return text;
}

/// A line of an equation that may be broken behind a point where it is long, and not within a name.
std::string breakable(std::string line) {
  constexpr std::size_t kShort = 80;
  constexpr std::string_view kTimes = "·", kMayBreak = "·<wbr>";
  if (line.size() <= kShort) return line;
  for (std::size_t at = line.find(kTimes); at != std::string::npos;
       at = line.find(kTimes, at + kMayBreak.size()))
    line.replace(at, kTimes.size(), kMayBreak);
  return line;
}

/// How much of the machine unit a signal uses.
std::string use_text(double signal) {
  return signal < 10 ? fmt::format("{:.0f} %", 100 * signal) : readable(signal) + " times";
}

/// "(0, 0), (0.5, 1)": the points of a function; of many the first.
std::string points_text(const text::PointTable& points) {
  constexpr std::size_t kMost = 40;
  std::string text;
  for (std::size_t k = 0; k < std::min(kMost, points.x.size()); ++k)
    text += fmt::format("{}({}, {})", k == 0 ? "" : ", ", readable(points.x[k]), readable(points.y[k]));
  if (points.x.size() > kMost) text += fmt::format(" … {} in all", points.x.size());
  return text;
}

class DiagramWriter {
 public:
  explicit DiagramWriter(const DiagramReport& report)
      : report_(report),
        programme_(report.programme),
        diagram_(programme_.diagram),
        flat_(diagram::flatten(diagram_, report.blocks)),
        program_(network::assemble(flat_)),
        page_(diagram_.title.empty() ? programme_.name : diagram_.title) {}

  HtmlPage write() {
    links();
    origin();
    circuit();
    equations();
    curves();
    warnings();
    published();
    independent();
    const DiagramCheck check = examine(diagram_, flat_, program_, report_.progress);
    scaling(check);
    settings();
    static_test();
    stability(check);
    machines(check);
    return std::move(page_);
  }

 private:
  void links() {
    if (!report_.index.empty()) page_.link("All programmes of the atlas", report_.index);
    if (!report_.studio.empty()) page_.link("Open it in the studio, and turn its pots", report_.studio);
  }

  void origin() {
    const std::vector<std::string> words = head_comment(programme_.text);
    if (!diagram_.published && diagram_.source.empty() && words.empty()) return;
    page_.heading("Where it comes from");
    if (const auto& published = diagram_.published) {
      page_.paragraph(capitalised(diagram::citation(*published)) + ".");
      if (published->address.starts_with("http")) page_.link(published->address, published->address);
      page_.paragraph(published->kind == diagram::Published::Kind::equations
                          ? "Composed here: no circuit, or no result of a machine, was published."
                          : "The circuit as it was patched" +
                                (published->machine.empty() ? "." : ", on: " + published->machine + "."));
    } else if (!diagram_.source.empty()) {
      page_.paragraph(diagram_.source + ".");
    }
    for (const std::string& paragraph : words) {
      if (paragraph.starts_with(' ')) {
        page_.element("<pre>" + draw::escape_xml(paragraph) + "</pre>");
      } else {
        page_.paragraph(paragraph);
      }
    }
    if (diagram_.published && !diagram_.published->errata.empty()) {
      page_.subheading("Errata of the publication");
      page_.list(diagram_.published->errata);
    }
  }

  void circuit() {
    page_.heading("The circuit");
    page_.introduction(fmt::format("{}, for {}.", count(diagram_.blocks.size(), "block", "blocks"),
                                   diagram_.machine.profile == "ideal"
                                       ? std::string("an ideal machine")
                                       : "the " + diagram::find_machine(diagram_.machine.profile)->title) +
                       (diagram_.machine.inverting ? " Summers and integrators invert." : ""));
    page_.picture(draw::draw_diagram(diagram_, report_.blocks));
  }

  /// The circuit in ideal elements, which invert as they do.
  diagram::FlatDiagram ideal_circuit() const {
    return diagram::flatten_on_ideal_elements(diagram_, report_.blocks);
  }

  void equations() {
    page_.heading("What it solves");
    page_.introduction(
        "Read back from the wires: summers, coefficients, signs and scale factors are multiplied out. "
        "Outputs "
        "stand in their units, other signals in machine units; t is the time of the run in seconds. "
        "Every integrator operates here, and the amplifiers are ideal.");
    std::string lines;
    const diagram::FlatDiagram circuit = with_ideal_amplifiers(ideal_circuit());
    for (const RecoveredEquation& equation : recovered_equations(circuit))
      lines += "<span>" + breakable(draw::escape_xml(printed(equation))) + "</span>";
    page_.element("<pre>" + lines + "</pre>");
    const std::vector<text::PointTable> tables = recovered_tables(circuit);
    if (tables.empty()) return;
    page_.introduction("Functions by straight lines from point to point, in machine units:");
    Table table({"function", "points"});
    for (std::size_t k = 0; k < tables.size(); ++k)
      table.add({fmt::format("table{}", k + 1), points_text(tables[k])});
    page_.table(table.rows());
  }

  void curves() {
    page_.heading("Curves");
    const bool plotted = diagram_.published && !diagram_.published->plot.empty();
    if (plotted) {
      page_.introduction("As on the plotter:");
      page_.picture(draw::draw_chart(plotter_chart(programme_, report_.blocks)));
    }
    if (plotted && diagram_.published->plot.back() == "t") return;
    page_.introduction("Over the time:");
    draw::Chart chart = chart_with({});
    chart.width = kBroadPage;
    page_.picture(draw::draw_chart(chart));
  }

  /// What the runs warn of.
  void warnings() {
    for (const text::Diagnostic& warning : programme_.run.warnings)
      page_.paragraph("Warning: " + text::to_string(warning, report_.vocabulary));
    for (const PublishedResult& result : programme_.results) {
      for (const text::Diagnostic& warning : result.warnings)
        page_.paragraph(fmt::format("Warning, in the run for {}: {}", diagram::name_of(result.value),
                                    text::to_string(warning, report_.vocabulary)));
    }
  }

  draw::Chart chart_with(const RunChartRequest& request) const {
    const solve::RunOptions options = solve::options_of(diagram_.run);
    return chart_of(programme_.run, rounding_of(flat_, options),
                    drawn_columns(programme_.run.trajectory.columns(), request), "");
  }

  void published() {
    if (!diagram_.published) return;
    page_.heading("Published and computed");
    if (!diagram_.published->picture.empty())
      page_.paragraph("The published picture shows: " + diagram_.published->picture + ".");
    if (programme_.results.empty()) {
      page_.paragraph("No value was published to hold the run against.");
      return;
    }
    page_.introduction(
        "The uncertainty is what the author stated, or that of reading what was published; the difference is "
        "a part of it, and up to 1 of it is "
        "agreement.");
    std::vector<std::vector<std::string>> rows = agreement_table({programme_}).rows();
    for (std::vector<std::string>& row : rows) row.erase(row.begin());  // the programme's name
    page_.table(rows);
    for (const PublishedResult& result : programme_.results) {
      const std::string name = diagram::name_of(result.value);
      if (!result.met() && result.is_explained())
        page_.paragraph(fmt::format("{} differs: {}.", name, result.value.because));
      if (!result.met() && !result.value.tried.empty())
        page_.paragraph(
            fmt::format("{} differs, and that is not explained. Tried: {}.", name, result.value.tried));
    }
  }

  void independent() {
    if (programme_.expected.empty()) return;
    page_.heading("Against an independent solution");
    page_.introduction("What the file says of the values, and within which bound they are to be met.");
    Table table({"value", "expected", "within", "computed", "difference", ""});
    for (const ExpectationResult& result : programme_.expected) {
      table.add({result.expectation.text, fmt::format("{:.9g}", result.expectation.value),
                 fmt::format("{:.2g}", result.expectation.within), fmt::format("{:.9g}", result.actual),
                 fmt::format("{:.1e}", std::abs(result.actual - result.expectation.value)),
                 result.met ? "met" : "NOT MET"});
    }
    page_.table(table.rows());
  }

  /// What 1 machine unit of a signal is, by the outputs that show it.
  std::string meaning(std::size_t block, std::size_t port) const {
    std::string text;
    for (const diagram::FlatOutput& output : flat_.outputs) {
      if (!(output.signal == diagram::SignalRef{block, port})) continue;
      if (output.unit == "machine unit" && output.scale == 1) continue;
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", output.name, readable(output.scale));
      if (output.unit != "1") text += " " + output.unit;
    }
    return text;
  }

  std::string label_of(const std::string& path) const {
    const auto block = std::find_if(diagram_.blocks.begin(), diagram_.blocks.end(),
                                    [&](const diagram::BlockInstance& b) { return b.name == path; });
    return block == diagram_.blocks.end() || block->label == path ? "" : block->label;
  }

  void scaling(const DiagramCheck& check) {
    page_.heading("Scaling");
    if (!check.in_full().run) {
      page_.paragraph("The run fails, so that no largest signal is known: " +
                      words_of(solve::SolveError(*check.analysis.failure), report_.vocabulary));
      return;
    }
    page_.introduction(
        "The largest signal of each amplifier over the run, and how much of the machine unit it makes use "
        "of; "
        "what goes beyond 100 % overloads a real machine" +
        std::string(diagram_.machine.profile == "ideal" ? ", unless it is scaled for one." : "."));
    Table table(
        {"element", "label", "kind", "largest [machine unit]", "at t [s]", "use", "1 machine unit is"});
    std::size_t signal = 0;
    for (std::size_t b = 0; b < flat_.blocks.size(); ++b) {
      const diagram::FlatBlock& block = flat_.blocks[b];
      const std::size_t first = signal;
      signal += block.definition->outputs.size();
      const diagram::Role role = block.definition->role;
      if (!is_top_level(block.path) || machine::is_coefficient(role) || role == diagram::Role::reference)
        continue;
      for (std::size_t port = 0; port < block.definition->outputs.size(); ++port) {
        const solve::Peak& peak = check.in_full().run->peaks.at(first + port);
        table.add({flat_.signal_name({b, port}), label_of(block.path), block.definition->title,
                   readable(peak.value), readable(peak.time), use_text(std::abs(peak.value)),
                   meaning(b, port)});
      }
    }
    page_.table(table.rows());
  }

  /// Whether the diagram's file gives a parameter of a block its value.
  bool is_set(const std::string& path, const std::string& parameter) const {
    const auto block = std::find_if(diagram_.blocks.begin(), diagram_.blocks.end(),
                                    [&](const diagram::BlockInstance& b) { return b.name == path; });
    return block != diagram_.blocks.end() &&
           std::any_of(block->settings.begin(), block->settings.end(),
                       [&](const text::Entry& entry) { return entry.key == parameter; });
  }

  /// Settings of potentiometers, weights of inputs and initial values of what stands on the patch panel.
  void settings() {
    Table table({"set", "label", "to", "for"});
    for (const diagram::FlatBlock& block : flat_.blocks) {
      if (!is_top_level(block.path)) continue;
      for (std::size_t k = 0; k < block.inputs.size(); ++k) {
        for (const diagram::FlatTerm& term : block.inputs[k].terms) {
          if (std::abs(term.weight) == 1) continue;
          table.add({fmt::format("{}.{}", block.path, block.definition->inputs[k].name), label_of(block.path),
                     fmt::format("{:.6g}", term.weight), "weight of " + flat_.signal_name(term.signal)});
        }
      }
      for (std::size_t k = 0; k < block.parameters.size(); ++k) {
        const diagram::ParameterDefinition& parameter = block.definition->parameters[k];
        if (parameter.points || parameter.formula) continue;
        if (!is_set(block.path, parameter.name) || std::isinf(block.parameters[k])) continue;  // ideal
        table.add({fmt::format("{}.{}", block.path, parameter.name), label_of(block.path),
                   fmt::format("{:.6g}", block.parameters[k]),
                   parameter.unit == "1" ? block.definition->title
                                         : fmt::format("{} [{}]", block.definition->title, parameter.unit)});
      }
    }
    if (table.rows().size() == 1) return;
    page_.heading("Settings");
    page_.introduction("Every potentiometer, weight and initial value that is to be set by hand.");
    page_.table(table.rows());
  }

  void static_test() {
    page_.heading("Static test");
    page_.introduction(
        "What each element of the panel shows, and how fast each integrator begins to run, before the clock "
        "starts; what stands inside of blocks is left out.");
    const diagram::MachineProfile* const machine = diagram::find_machine(diagram_.machine.profile);
    const double volts = machine->unit.value_or(1);
    const bool in_volts = diagram_.machine.profile != "ideal" && machine->unit.has_value();
    Table table({"element", in_volts ? "output [V]" : "output [machine unit]",
                 in_volts ? "d/dt [V/s]" : "d/dt [machine unit/s]"});
    std::set<std::string> shown;
    for (std::size_t b = 0; b < flat_.blocks.size(); ++b) {
      if (!is_top_level(flat_.blocks[b].path)) continue;
      for (std::size_t port = 0; port < flat_.blocks[b].definition->outputs.size(); ++port)
        shown.insert(flat_.signal_name({b, port}));
    }
    try {
      for (const solve::StaticReading& reading :
           solve::static_test(network::Program(network::assemble(ideal_circuit())), diagram_.file)) {
        if (!shown.contains(reading.signal)) continue;
        table.add({reading.signal, readable(reading.output * (in_volts ? volts : 1)),
                   !reading.derivative ? ""
                   : reading.at_rest   ? "at rest"
                                       : readable(*reading.derivative * (in_volts ? volts : 1))});
      }
    } catch (const text::Error& error) {
      page_.paragraph("There is none: " + words_of(error, report_.vocabulary));
      return;
    }
    page_.table(table.rows());
  }

  void stability(const DiagramCheck& check) {
    page_.heading("Stability");
    const solve::Analysis& analysis = check.analysis;
    page_.paragraph(capitalised(verdict_text(analysis.stability)) + ".");
    if (analysis.instants.empty() || program_.n_states() == 0) return;
    page_.introduction(fmt::format(
        "The eigenvalues of the circuit, linearised at {} of its run: one with a positive real part grows.",
        count(analysis.stability.instants, "moment", "moments")));
    page_.picture(draw::draw_chart(pole_chart(flat_, program_, analysis.instants, "")));
  }

  void machines(const DiagramCheck& check) {
    page_.heading("Machines");
    if (check.components) {
      page_.introduction(
          fmt::format("What it takes of the {}, and what there is:", check.components->machine));
      page_.table(component_list_table(*check.components).rows());
      page_.paragraph(capitalised(verdict_text(*check.components)) + ".");
    }
    page_.introduction(
        "Whether other machines have what it takes, once it is made of their elements and scaled for "
        "them, as " +
        text::Remedy{text::Action{"patch", diagram_.file}, " does:"}.words(report_.vocabulary));
    Table table({"machine", "verdict"});
    for (const std::string& name : diagram::machine_names()) {
      if (name == "ideal" || name == diagram_.machine.profile) continue;
      const diagram::MachineProfile& other = *diagram::find_machine(name);
      table.add({other.title, verdict_on(other)});
    }
    page_.table(table.rows());
  }

  /// Whether a machine has what the diagram takes in its elements.
  std::string verdict_on(const diagram::MachineProfile& machine) const {
    try {
      const machine::ScaledRealisation made = machine::realise_scaled(diagram_, report_.blocks, machine);
      return verdict_text(
          machine::component_list_of(diagram::flatten(made.diagram, report_.blocks), machine));
    } catch (const text::Error& error) {
      return "it cannot be put onto it: " + error.diagnostics().front().what;
    }
  }

  const DiagramReport& report_;
  const Programme& programme_;
  const diagram::Diagram& diagram_;
  diagram::FlatDiagram flat_;
  network::Program program_;
  HtmlPage page_;
};

}  // namespace

HtmlPage DiagramReport::page() const {
  return DiagramWriter(*this).write();
}

std::vector<std::string> head_comment(const std::string& text) {
  std::vector<std::string> paragraphs;
  bool begins = true;
  for (std::size_t at = 0; at < text.size() && text[at] == '#';) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at + 1, end - at - 1);
    at = end + 1;
    if (line.starts_with(' ')) line.erase(0, 1);
    const bool blank = line.find_first_not_of(" \t\r") == std::string::npos;
    const bool indented = line.starts_with("  ");
    const bool follows_indented = !paragraphs.empty() && paragraphs.back().starts_with(' ');
    if (!blank && (begins || indented != follows_indented)) {
      paragraphs.push_back(line);
    } else if (!blank) {
      paragraphs.back() += (indented ? "\n" : " ") + line;
    }
    begins = blank;
  }
  return paragraphs;
}

draw::Chart plotter_chart(const Programme& programme, const diagram::BlockLibrary& blocks) {
  RunChartRequest request;
  if (programme.diagram.published && !programme.diagram.published->plot.empty()) {
    const std::vector<std::string>& plot = programme.diagram.published->plot;
    request.columns = {plot.begin(), plot.end() - 1};
    if (plot.back() != "t") request.against = plot.back();
  }
  const diagram::FlatDiagram flat = diagram::flatten(programme.diagram, blocks);
  return chart_of(programme.run, rounding_of(flat, solve::options_of(programme.diagram.run)),
                  drawn_columns(programme.run.trajectory.columns(), request), "");
}

}  // namespace oblique::report
