// SPDX-License-Identifier: MIT
#include <oblique/report/diagram_check_json.h>

#include <nlohmann/json.hpp>

#include <oblique/solve/operating_point/rest.h>

#include <oblique/network/program/program.h>
#include <oblique/report/diagram_check_text.h>
#include <oblique/report/json_text.h>

namespace oblique::report {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json optional_number(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json run_json(const DiagramCheck& check) {
  const solve::Analysis& analysis = check.analysis;
  if (analysis.failure) {
    return {{"until", check.diagram.run.until},
            {"failed", analysis.failure->diagnostics().front().what},
            {"time", analysis.failure->time()}};
  }
  return {{"until", check.diagram.run.until},
          {"steps", analysis.run->statistics.steps},
          {"method", diagram::method_name(analysis.run->method.method)},
          {"reason", analysis.run->method.reason}};
}

Json loop_json(const solve::LoopReport& loop) {
  Json unknowns = Json::array();
  for (const solve::LoopUnknown& unknown : loop.unknowns) {
    unknowns.push_back({{"signal", unknown.signal},
                        {"least_gain", unknown.least_gain},
                        {"least_gain_time", unknown.least_time},
                        {"greatest_gain", unknown.greatest_gain},
                        {"static_error", optional_number(unknown.static_error)},
                        {"sign", unknown.sign},
                        {"sign_changes", unknown.sign_changes}});
  }
  return {{"type", loop.algebraic ? "algebraic" : "servo"},
          {"members", loop.members},
          {"kind", kind_name(loop.kind)},
          {"time_constant", optional_number(loop.time_constant)},
          {"unknowns", std::move(unknowns)}};
}

Json mode_json(const std::optional<solve::WorstMode>& worst, const network::Program& program) {
  if (!worst) return nullptr;
  const solve::Mode& mode = worst->mode;
  Json participants = Json::array();
  for (const auto& [state, share] : mode.participants) {
    participants.push_back({{"signal", program.states()[state].name}, {"share", share}});
  }
  return {{"pole", {mode.pole.real(), mode.pole.imag()}},
          {"natural_frequency", mode.natural_frequency()},
          {"damping_ratio", mode.damping_ratio()},
          {"verdict", verdict_name(solve::verdict_on(*worst))},
          {"time", worst->time},
          {"ideal_pole",
           worst->ideal_pole ? Json({worst->ideal_pole->real(), worst->ideal_pole->imag()}) : Json(nullptr)},
          {"participants", std::move(participants)}};
}

Json stability_json(const solve::StabilityReport& report, const network::Program& program) {
  Json margins = Json::array();
  for (const solve::ServoMargin& servo : report.margins) {
    Json margin{{"signal", program.states()[servo.state].name}};
    margin["degrees"] = servo.margin ? Json(servo.margin->degrees) : Json(nullptr);
    margin["frequency"] = servo.margin ? Json(servo.margin->frequency) : Json(nullptr);
    margin["time"] = servo.time;
    margins.push_back(std::move(margin));
  }
  Json growth = nullptr;
  if (report.growth) {
    growth = {{"from", report.growth->from},
              {"to", report.growth->to},
              {"factor", report.growth->factor},
              {"exponent", report.growth->exponent}};
  }
  return {{"instants", report.instants},
          {"verdict", verdict_name(report.verdict)},
          {"proven", report.proven},
          {"growing", report.growing},
          {"varies", report.varies},
          {"growth", std::move(growth)},
          {"rightmost_mode", mode_json(report.rightmost, program)},
          {"servo_mode", mode_json(report.servo_mode, program)},
          {"slowest_servo", mode_json(report.slowest_servo, program)},
          {"grows_from", optional_number(report.grows_from)},
          {"problem_mode", mode_json(report.problem_mode, program)},
          {"margins", std::move(margins)},
          {"left_out", report.left_out}};
}

Json overloads_json(const DiagramCheck& check) {
  if (!check.analysis.run) return nullptr;
  Json list = Json::array();
  for (const solve::OverloadRecord& o : check.in_full().run->overloads) {
    list.push_back({{"signal", check.program.signal_names()[o.signal]},
                    {"first", o.first},
                    {"peak", o.peak.value},
                    {"peak_time", o.peak.time},
                    {"duration", o.duration},
                    {"scale", o.suggested_scale}});
  }
  return list;
}

Json scaling_json(const DiagramCheck& check) {
  if (!check.scaling) return nullptr;
  Json signals = Json::array();
  for (std::size_t s = 0; s < check.scaling->signals.size(); ++s) {
    const solve::Peak& peak = check.in_full().run->peaks[s];
    signals.push_back({{"signal", check.program.signal_names()[s]},
                       {"peak", peak.value},
                       {"peak_time", peak.time},
                       {"scale", check.scaling->signals[s]}});
  }
  return {{"signals", std::move(signals)}, {"time_scale", check.scaling->time_scale}};
}

Json component_list_json(const std::optional<machine::ComponentList>& components) {
  if (!components) return nullptr;
  Json rows = Json::array();
  for (const machine::ComponentListRow& row : components->rows) {
    rows.push_back({{"element", row.element},
                    {"needed", row.needed},
                    {"at_least", row.at_least},
                    {"exists", row.exists},
                    {"is_block", row.is_block},
                    {"available", row.available ? Json(*row.available) : Json()},
                    {"missing", row.missing()}});
  }
  const machine::ComponentList::Verdict verdict = components->verdict();
  const Json fits = verdict == machine::ComponentList::Verdict::cannot_tell
                        ? Json()
                        : Json(verdict == machine::ComponentList::Verdict::fits);
  return {{"machine", components->machine}, {"rows", std::move(rows)}, {"fits", fits}};
}

}  // namespace

std::string to_json(const DiagramCheck& check) {
  Json loops = Json::array();
  for (const solve::LoopReport& loop : check.analysis.loops) loops.push_back(loop_json(loop));
  Json json{{"file", check.file},
            {"kind", "diagram"},
            {"title", check.diagram.title},
            {"blocks", check.diagram.blocks.size()},
            {"elements", check.flat.blocks.size()},
            {"states", check.program.n_states()},
            {"servo_amplifiers", solve::rest_states(check.program).size()},
            {"outputs", check.flat.outputs.size()}};
  json["bill"] = component_list_json(check.components);
  json["run"] = run_json(check);
  json["loops"] = std::move(loops);
  json["stability"] = stability_json(check.analysis.stability, check.program);
  json["overloads"] = overloads_json(check);
  json["scaling"] = scaling_json(check);
  return json_text(json);
}

}  // namespace oblique::report
