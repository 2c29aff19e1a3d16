// SPDX-License-Identifier: MIT
#include <oblique/solve/events/event_log.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <oblique/solve/run_errors.h>

namespace oblique::solve {
namespace {

constexpr std::size_t kMostRecords = 1000, kMostTimes = 1'000'000;

bool contains(const std::vector<std::uint32_t>& units, std::uint32_t unit) {
  return std::find(units.begin(), units.end(), unit) != units.end();
}

/// Where a comparison, "in > 0", turns over: "in = 0".
std::string boundary_of(std::string comparison) {
  constexpr std::string_view kAbove = " > ";
  const std::size_t at = comparison.find(kAbove);
  if (at == std::string::npos || comparison.find(kAbove, at + 1) != std::string::npos)
    return fmt::format("where {} turns over", comparison);
  return comparison.replace(at, kAbove.size(), " = ");
}

constexpr std::string_view kOfSwitches = "the loop of the switches of ";

}  // namespace

const network::Switch& EventLog::first_of(std::uint32_t unit) const {
  return program_.switches()[program_.switch_structure().members[unit].front()];
}

void EventLog::record(double t, std::string what) {
  ++count_;
  if (records_.size() < kMostRecords) records_.push_back({t, std::move(what)});
  if (times_.size() < kMostTimes) times_.push_back(t);
}

void EventLog::record_turn(std::size_t s, double position, double t) {
  record(t, fmt::format("{}: {} {}", program_.switches()[s].block, program_.switches()[s].comparison,
                        position > 0 ? "from now on" : "no longer"));
}

void EventLog::record_slides(const std::vector<std::uint32_t>& before,
                             const std::vector<SlidingMode::Doubt>& doubts, const SlidingMode& slide,
                             double t) {
  const auto tell = [&](std::uint32_t unit, const char* what) {
    const network::Switch& s = first_of(unit);
    record(t, fmt::format("{}: {} {}", s.block, what, boundary_of(s.comparison)));
  };
  for (std::size_t u = 0; u < before.size(); ++u) {
    if (contains(slide.units(), before[u])) continue;
    tell(before[u], "leaves");
    warn_of_leaving(before[u], doubts[u], t);
  }
  for (const std::uint32_t unit : slide.units()) {
    if (!contains(before, unit)) tell(unit, "stays at");
  }
  warn_of_uncounted(slide, t);
  if (slide.units() != before) warn_of_acting_together(slide, t);
  look_along(slide, t);
}

/// A switch that turns along may have come to zero in this moment alone, as an integrator leaves its limit:
/// it is told of where it is still there later.
void EventLog::look_along(const SlidingMode& slide, double t) {
  along_since_.resize(program_.switches().size());
  for (std::uint32_t s = 0; s < along_since_.size(); ++s) {
    std::optional<double>& since = along_since_[s];
    if (!slide.turns_along(s))
      since.reset();
    else if (!since)
      since = t;
    else if (t > *since)
      warn_of_turning_along(s, *since);
  }
}

void EventLog::warn(text::Diagnostic warning) {
  const auto subject = [](const text::Diagnostic& of) { return of.what.substr(0, of.what.find(':')); };
  const auto told = std::find_if(warnings_.begin(), warnings_.end(), [&](const text::Diagnostic& other) {
    return subject(other) == subject(warning);
  });
  if (told != warnings_.end())
    *told = std::move(warning);  // on the way to where it settles it was told of before
  else
    warnings_.push_back(std::move(warning));
}

/// A warning about a unit that is the same each time but for what follows `what`; once for each unit: it may
/// come back.
void EventLog::warn_of_unit(std::uint32_t unit, const char* what, const std::string& rest,
                            const char* remedy) {
  const network::Switch& s = first_of(unit);
  const std::string begin = fmt::format("'{}' ({}) {}", s.block, s.comparison, what);
  const bool told = std::any_of(warnings_.begin(), warnings_.end(), [&](const text::Diagnostic& warning) {
    return warning.what.starts_with(begin);
  });
  if (!told) warnings_.push_back({{file_, {}}, begin + rest, {}, remedy});
}

/// Tells what is uncertain where a slide ends.
void EventLog::warn_of_leaving(std::uint32_t unit, SlidingMode::Doubt doubt, double t) {
  constexpr const char* kLeaves = "leaves the switching surface that it slides along";
  switch (doubt) {
    case SlidingMode::Doubt::none:
      return;
    case SlidingMode::Doubt::of_side:
      return warn_of_unit(
          unit, kLeaves,
          fmt::format(" at t = {:.9g} s, since both of its sides drive away from it from then on: rounding "
                      "decides to which side it goes",
                      t),
          "end the run before, or add the disturbance that decides it on the machine");
    case SlidingMode::Doubt::of_whether:
      return warn_of_unit(
          unit, kLeaves,
          fmt::format(" at t = {:.9g} s, since one of its sides drives away from it from then on, and on the "
                      "other nothing moves it: it could as well stay",
                      t),
          "give the comparison a hysteresis");
    case SlidingMode::Doubt::of_time:
      return warn_of_unit(
          unit, kLeaves,
          fmt::format(" at t = {:.9g} s, where what it switches hardly moves what it compares any more: when "
                      "it leaves is known only roughly",
                      t),
          "end the run before, or compare what the switch moves all along");
  }
}

void EventLog::warn_of_no_side(std::uint32_t unit, double t) {
  warn_of_unit(
      unit, "stands on its switching surface",
      fmt::format(" at t = {:.9g} s, and both of its sides drive away from it: nothing decides to which "
                  "side it goes",
                  t),
      "begin a little to the side that is meant, or add the disturbance that decides it on the machine");
}

void EventLog::warn_of_hidden(std::uint32_t s, bool holds, double since, double t, double error) {
  const network::Switch& made = program_.switches()[s];
  warn({{file_, {}},
        fmt::format(
            "'{}' ({}) {} from t = {:.9g} s to t = {:.9g} s, though what it compares lies on the other "
            "side: by less than its error, {:.2g}, so that it may be late or never turn over",
            made.block, made.comparison, holds ? "holds" : "does not hold", since, t, error),
        {},
        {"tighten ", text::Setting{"tolerance"},
         ", or make what it compares larger: a slower element, a higher resistance, a lower rate"}});
}

/// Tells that what is slid along is taken as if two switches turned over independently of each other.
void EventLog::warn_of_acting_together(const SlidingMode& slide, double t) {
  const auto units = slide.act_together();
  if (!units) return;
  warn_of_unit(
      units->first, "slides along its switching surface",
      fmt::format(" together with '{}' from t = {:.9g} s on, and what follows depends on how the turns "
                  "of the one fall in with those of the other: they are taken as independent",
                  first_of(units->second).block, t),
      "give the comparisons a hysteresis, so that the diagram says when they turn over");
}

void EventLog::warn_of_turning_along(std::uint32_t s, double since) {
  warn_of_unit(
      program_.switch_structure().unit[s], "is at zero along with what slides",
      fmt::format(" from t = {:.9g} s on, and would turn over as often: it is taken to stay where it is",
                  since),
      "give the comparison a hysteresis, or let one comparison decide for both");
}

void EventLog::warn_of_halt(std::uint32_t unit, double t) {
  warn_of_unit(
      unit, "stops on the switching surface that it slid along",
      fmt::format(" at t = {:.9g} s, where nothing moves it any more: rounding decides on which side "
                  "it stays",
                  t),
      "give the comparison a hysteresis, or do not read it while it rests");
}

void EventLog::warn_of_stop(std::uint32_t unit, double t) {
  warn_of_unit(
      unit, "stops at its level",
      fmt::format(" at t = {:.9g} s, where nothing moves what it compares as long as neither it nor its "
                  "negative is above zero: the least offset lets it go on",
                  t),
      "give the comparisons a hysteresis, or let a flip-flop keep what they decide");
}

void EventLog::warn_of_rest(std::uint32_t unit, double since, double t) {
  warn_of_unit(
      unit, "rests at its level",
      fmt::format(" from t = {:.9g} s on, where its own turn has stopped what it compares, and at t = {:.9g} "
                  "s what follows depends on it: at its level it does not hold, but by the least offset it "
                  "would",
                  since, t),
      "give the comparison a hysteresis, compare with a level beside this one, or do not read it while it "
      "rests");
}

void EventLog::warn_of_held(std::uint32_t s, double t) {
  const network::Switch& made = program_.switches()[s];
  warn({{file_, {}},
        fmt::format("'{}' ({}) holds from t = {:.9g} s on, where what it compares is held at its very level: "
                    "there the least offset decides",
                    made.block, made.comparison, t),
        {},
        "compare with a level beside this one"});
}

void EventLog::forget_choices() {
  std::erase_if(warnings_,
                [](const text::Diagnostic& warning) { return warning.what.starts_with(kOfSwitches); });
}

void EventLog::warn_of_choice(const std::vector<std::uint32_t>& switches, const network::Workspace& workspace,
                              double t) {
  std::vector<std::string> names;
  names.reserve(switches.size());
  for (const std::uint32_t s : switches) names.push_back(fmt::format("'{}'", program_.switches()[s].block));
  const network::Switch& first = program_.switches()[switches.front()];
  constexpr std::string_view kHas = " has several solutions";
  const bool told = std::any_of(warnings_.begin(), warnings_.end(), [&](const text::Diagnostic& warning) {
    return warning.what.starts_with(kOfSwitches) &&
           std::all_of(names.begin(), names.end(),
                       [&](const auto& name) { return warning.what.find(name) < warning.what.find(kHas); });
  });
  if (told) return;
  const std::string begin = fmt::format("{}{}{}", kOfSwitches, shortened(names), kHas);
  warnings_.push_back(
      {{file_, {}},
       fmt::format("{}: at t = {:.9g} s the run goes on with '{}' ({}) {}; nothing in the diagram chooses "
                   "between them",
                   begin, t, first.block, first.comparison,
                   workspace.discrete_state(first.discrete_state) == 1 ? "true" : "false"),
       {},
       "set the latch by one of its inputs then, or give one of its comparators a hysteresis and an "
       "'initial'"});
}

/// Tells of switches with events that slide, or follow what does: what these would do is not counted. What
/// rests on one side does nothing.
void EventLog::warn_of_uncounted(const SlidingMode& slide, double t) {
  constexpr std::string_view kWhen = " from t = ";
  const auto tell = [&](std::uint32_t s, std::string_view how) {
    const network::Switch& made = program_.switches()[s];
    const bool acts =
        std::any_of(program_.events().begin(), program_.events().end(), [&](const network::Event& event) {
          if (event.repeats) return false;  // a table goes along on both sides
          const auto read = program_.switch_structure().positions_in(event.condition);
          return std::binary_search(read.begin(), read.end(), s);
        });
    const std::string what = fmt::format(
        "'{}' ({}) {} along its switching surface{}{:.9g} s: it switches without end, which is not counted "
        "and not stored",
        made.block, made.comparison, how, kWhen, t);
    const bool told = std::any_of(warnings_.begin(), warnings_.end(), [&](const text::Diagnostic& warning) {
      return warning.what.substr(0, warning.what.find(kWhen)) == what.substr(0, what.find(kWhen));
    });
    if (acts && !told)
      warnings_.push_back({{file_, {}}, what, {}, "give the switch that slides a hysteresis"});
  };
  const auto rests = [&](std::uint32_t unit) {
    const auto at = std::find(slide.units().begin(), slide.units().end(), unit);
    return slide.rests_above(static_cast<std::size_t>(at - slide.units().begin())).has_value();
  };
  for (const std::uint32_t unit : slide.units()) {
    if (rests(unit)) continue;
    for (const std::uint32_t s : program_.switch_structure().members[unit]) tell(s, "slides");
  }
  for (const std::uint32_t s : slide.followers()) {
    if (!slide.is_torn(s) || rests(slide.followed_by(s))) continue;
    tell(s, fmt::format("depends on '{}', which slides", first_of(slide.followed_by(s)).block));
  }
}

SolveError EventLog::endless(const std::string& block, const std::string& what, double t) const {
  return {
      SolveError::Kind::chatter,
      t,
      {{file_, {}},
       fmt::format("{} without end at t = {:.9g} s ({})",
                   block.empty() ? "its switches turn over" : fmt::format("'{}' switches", block), t, what),
       {},
       "give the switch a hysteresis, or a larger one, or an ideal amplifier in its loop a finite gain and "
       "bandwidth"}};
}

SolveError EventLog::too_many(const std::string& block, std::size_t count, std::size_t most, double t) const {
  return {
      SolveError::Kind::chatter,
      t,
      {{file_, {}},
       fmt::format(
           "'{}' and {} other switches that act on each other lie on their switching points at t = {:.9g} "
           "s",
           block, count - 1, t),
       fmt::format("at most {} at one instant", most),
       "let some of them come a little before the others, by other levels or initial values"}};
}

SolveError EventLog::piled_up(const std::string& block, const std::string& comparison, double at,
                              double t) const {
  return {
      SolveError::Kind::chatter,
      t,
      {{file_, {}},
       fmt::format("'{}' ({}) turns over ever faster: its turns pile up at t = {:.4g} s, and what follows "
                   "is decided by errors",
                   block, comparison, at),
       {},
       "end the run before, or give the switch a hysteresis"}};
}

SolveError EventLog::endless(const std::string& what, double t) const {
  return endless(records_.empty() ? "" : records_.back().what, what, t);
}

}  // namespace oblique::solve
