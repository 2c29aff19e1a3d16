// SPDX-License-Identifier: MIT
#include "studio/engine/live_comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <oblique/draw/chart/chart.h>
#include <oblique/draw/picture/svg.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/report/comparison_chart.h>

#include "studio/engine/options.h"
#include "studio/engine/patch_request.h"

namespace oblique::studio {
namespace {

Json known(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

Json run_json(const compare::ComparedRun& run) {
  Json json{{"gain", run.gain}, {"max_error", run.max_error}, {"rms_error", run.rms_error}};
  json["static"] = run.parts ? Json(run.parts->at_rest) : Json();
  json["lag"] = run.parts ? Json(run.parts->lag) : Json();
  json["solver"] = run.parts ? Json(run.parts->solver) : Json();
  json["worst"] = run.worst.point;
  json["steps"] = run.steps;
  json["overloads"] = run.overloads.size();
  json["stable"] = run.stable;
  json["off_branch"] = run.left_branch.has_value();
  return json;
}

}  // namespace

Answer LiveComparison::open(const std::string& text, const std::string& name, const std::string& options) {
  return answer([&] {
    engine_.check_size(text, name);
    const Options asked(options, {"bandwidth", "slower", "method", "split"});
    const patch::PatchOptions how = patch_options(asked);
    mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, name);
    compare::CompareOptions comparing;
    comparing.methods = {how.method};
    if (how.bandwidth) comparing.bandwidths = {*how.bandwidth};
    comparing.split = how.split;
    comparing.slower = how.slower;
    Answer opened;
    opened.object["unit"] = mechanism.length_unit;
    opened.object["size"] = mechanism.largest_length();
    mechanism_ = std::move(mechanism);
    options_ = std::move(comparing);
    all_ = {};
    return opened;
  });
}

Answer LiveComparison::add(double gain) {
  return answer([&] {
    if (!mechanism_)
      throw text::ReadError(text::Diagnostic{{}, "no mechanism is held", "a mechanism", "open one"});
    if (!(gain > 0 && std::isfinite(gain)))
      throw text::ReadError(
          text::Diagnostic{{}, fmt::format("the gain is {}", gain), "a finite number above 0", {}});
    options_.gains = {gain};
    compare::Comparison one = compare::compare(*mechanism_, *engine_.library(), options_);
    std::vector<compare::ComparedRun> runs = std::move(all_.runs);
    std::erase_if(runs, [&](const compare::ComparedRun& run) { return run.gain == gain; });
    runs.push_back(std::move(one.runs.front()));
    std::sort(runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.gain < b.gain; });
    all_ = std::move(one);
    all_.runs = std::move(runs);
    compare::GainSeries& series = all_.series.front();
    series.n = all_.runs.size();
    series.order = compare::fitted_order(all_.runs, series.floor.value_or(0));

    Answer added;
    Json& json = added.object;
    json["runs"] = Json::array();
    for (const compare::ComparedRun& run : all_.runs) json["runs"].push_back(run_json(run));
    json["order"] = known(series.order);
    json["floor"] = known(series.floor);
    json["svg"] = draw::to_svg(draw::draw_chart(report::parts_chart(all_)));
    return added;
  });
}

}  // namespace oblique::studio
