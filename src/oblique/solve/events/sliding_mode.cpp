// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/solve/events/sliding_mode.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace oblique::solve {
namespace {

/// What integration lets a surface drift off is taken back at this rate, times the length of the run, by no
/// more than this part of what the sides do: the shares must not show it.
constexpr double kReturn = 100;
constexpr double kMostReturn = 1e-6;

/// How far beyond 0 and 1 the shares may be where a slide begins: a solution may run along a surface by
/// itself.
constexpr double kEdge = 2 * kMostReturn;

/// How far the states are moved to see whether a slide lasts [machine unit].
constexpr double kProbe = 1e-6;

/// A surface whose rate depends on the shares by less than this part of what others do stands still whatever
/// they are.
constexpr double kNoSlope = 1e-8;

/// Of the drive of the other side.
constexpr double kDrives = 1e-3;

constexpr std::size_t kMostCoupled = 8;
constexpr std::size_t kMostUnits = 64;

}  // namespace

SlidingMode::SlidingMode(const network::Program& program, network::Workspace& workspace, double span)
    : program_(program),
      workspace_(workspace),
      span_(span),
      follows_(program.switches().size(), false),
      rests_(program.switches().size(), false),
      strongest_(program.switch_structure().members.size()),
      scratch_(std::max(program.n_states(), program.jacobian_pattern().entries())),
      moved_(program.n_states()) {}

bool SlidingMode::holds(std::size_t s) const {
  return std::find(units_.begin(), units_.end(), program_.switch_structure().unit[s]) != units_.end();
}

void SlidingMode::find_followers() {
  std::fill(follows_.begin(), follows_.end(), false);
  followers_.clear();
  if (!active()) return;
  std::vector<bool> held(follows_.size());
  for (std::size_t s = 0; s < held.size(); ++s) held[s] = holds(s);
  follows_ = program_.switch_structure().followers_of(held);
  for (std::uint32_t s = 0; s < follows_.size(); ++s) {
    follows_[s] = follows_[s] && !held[s];
    if (follows_[s]) followers_.push_back(s);
  }
}

/// Units are of one cluster where they are coupled, directly or through others: positions that follow may
/// couple them too.
void SlidingMode::make_sides() {
  const network::SwitchStructure& structure = program_.switch_structure();
  const std::size_t n = units_.size();
  cluster_of_.resize(n);
  for (std::size_t u = 0; u < n; ++u) cluster_of_[u] = static_cast<std::uint32_t>(u);
  for (std::size_t u = 0; u < n; ++u) {
    for (std::size_t v = 0; v < u; ++v) {
      if (followers_.empty() && !structure.is_coupled(units_[u], units_[v])) continue;
      const std::uint32_t from = cluster_of_[u], to = cluster_of_[v];
      std::replace(cluster_of_.begin(), cluster_of_.end(), from, to);
    }
  }
  sides_.assign(1, Side{});
  for (std::uint32_t cluster = 0; cluster < n; ++cluster) {
    std::vector<std::uint32_t> members;
    for (std::uint32_t u = 0; u < n; ++u) {
      if (cluster_of_[u] == cluster) members.push_back(u);
    }
    for (std::uint32_t combination = 1; combination < (1U << std::min(members.size(), kMostCoupled));
         ++combination) {
      Side side;
      side.cluster = cluster;
      for (std::size_t k = 0; k < members.size(); ++k) {
        if ((combination >> k & 1U) != 0) side.bits |= std::uint64_t{1} << members[k];
      }
      sides_.push_back(std::move(side));
    }
  }
}

/// Puts the units on a side, and what follows them where its surfaces then are.
bool SlidingMode::settle(Side& side, double t, std::span<const double> x) {
  const network::SwitchStructure& structure = program_.switch_structure();
  for (std::size_t u = 0; u < units_.size(); ++u) {
    const bool above = (side.bits >> u & 1U) != 0;
    for (const std::uint32_t s : structure.members[units_[u]])
      workspace_.set_memory(program_.switches()[s].memory, above != structure.opposite[s] ? 1 : 0);
  }
  side.surfaces.resize(program_.switches().size());
  bool settled = followers_.empty();
  for (std::size_t round = 0; !settled; ++round) {
    if (round > 2 * followers_.size() + 2) return false;
    if (!program_.surfaces(t, x.data(), side.surfaces.data(), workspace_)) return false;
    settled = true;
    for (const std::uint32_t s : followers_) {
      const std::uint32_t memory = program_.switches()[s].memory;
      const double position = side.surfaces[s] > 0 ? 1 : 0;
      settled = settled && workspace_.memory(memory) == position;
      workspace_.set_memory(memory, position);
    }
  }
  side.positions.clear();
  const auto keep = [&](std::uint32_t s) {
    const std::uint32_t memory = program_.switches()[s].memory;
    side.positions.emplace_back(memory, workspace_.memory(memory));
  };
  for (const std::uint32_t unit : units_) {
    for (const std::uint32_t s : structure.members[unit]) keep(s);
  }
  for (const std::uint32_t s : followers_) keep(s);
  return true;
}

void SlidingMode::load(const Side& side) {
  for (const auto& [memory, position] : side.positions) workspace_.set_memory(memory, position);
}

void SlidingMode::load_base() {
  for (const auto& [memory, position] : base_) workspace_.set_memory(memory, position);
}

std::vector<std::uint64_t> SlidingMode::broken_by(const network::Program& program,
                                                  const std::vector<std::uint32_t>& units) {
  const network::SwitchStructure& structure = program.switch_structure();
  std::vector<std::uint64_t> broken(units.size(), 0);
  for (std::size_t u = 0; u < units.size(); ++u) {
    for (const std::uint32_t s : structure.members[units[u]]) {
      for (const std::uint32_t p : structure.positions_below(s)) {
        const auto other = std::find(units.begin(), units.end(), structure.unit[p]);
        if (other == units.end()) continue;
        const auto v = static_cast<std::size_t>(other - units.begin());
        if (u == v || program.switches()[p].turning == network::Turning::jumps)
          broken[u] |= std::uint64_t{1} << v;
      }
    }
  }
  return broken;
}

bool SlidingMode::begin(std::vector<std::uint32_t> units, double t, std::span<const double> x) {
  if (units.size() > kMostUnits) return false;
  const std::vector<double> before(workspace_.memories().begin(), workspace_.memories().end());
  units_ = std::move(units);
  find_followers();
  make_sides();
  base_.clear();
  for (std::uint32_t s = 0; s < follows_.size(); ++s) {
    const std::uint32_t memory = program_.switches()[s].memory;
    if (holds(s) || follows_[s]) base_.emplace_back(memory, workspace_.memory(memory));
  }
  bool possible = std::all_of(cluster_of_.begin(), cluster_of_.end(), [&](std::uint32_t cluster) {
    return std::count(cluster_of_.begin(), cluster_of_.end(), cluster) <= static_cast<long>(kMostCoupled);
  });
  for (Side& side : sides_) possible = possible && settle(side, t, x);
  const std::vector<std::uint64_t> broken = broken_by(program_, units_);
  possible = possible && std::none_of(broken.begin(), broken.end(), [](std::uint64_t by) { return by != 0; });
  shares_.assign(units_.size(), 0.5);
  const auto within = [](double share) { return share >= -kEdge && share <= 1 + kEdge; };
  if (possible && evaluate(t, x) && std::all_of(shares_.begin(), shares_.end(), within) && lasts(t, x)) {
    bool attracts = true;
    for (std::size_t u = 0; u < units_.size(); ++u)
      attracts = attracts && !(repulsion(u).value_or(0) > kNoRepulsion);
    if (attracts) {
      load_base();
      begun_ = true;
      return true;
    }
  }
  end();
  workspace_.load_memories(before);
  return false;
}

void SlidingMode::end() {
  if (active()) load_base();
  units_.clear();
  followers_.clear();
  std::fill(follows_.begin(), follows_.end(), false);
  std::fill(rests_.begin(), rests_.end(), false);
  sides_.clear();
  shares_.clear();
  begun_ = false;
}

bool SlidingMode::evaluate(Side& side, double t, std::span<const double> x) {
  load(side);
  side.dxdt.resize(program_.n_states());
  side.surfaces.resize(follows_.size());
  side.rates.resize(follows_.size());
  const auto here = program_.surfaces(t, x.data(), side.surfaces.data(), workspace_);
  if (!here) return false;
  here->derivatives(side.dxdt.data());
  here->surface_rates(side.dxdt.data(), side.rates.data());
  return true;
}

bool SlidingMode::evaluate(double t, std::span<const double> x) {
  bool valid = true;
  for (Side& side : sides_) valid = valid && evaluate(side, t, x);
  valid = valid && find_shares();
  load_base();
  for (std::size_t u = 0; valid && u < units_.size(); ++u)
    strongest_[units_[u]] = std::max(strongest_[units_[u]], std::abs(drive_apart(u)));
  return valid;
}

/// How much more the upper side of a unit drives up than its lower one; nothing of one that is coupled, or of
/// which one side does not drive, or both alike: that decides where it goes.
double SlidingMode::drive_apart(std::size_t unit) const {
  const auto alone = [&](const Side& side) { return side.bits == std::uint64_t{1} << unit; };
  const bool coupled = std::count(cluster_of_.begin(), cluster_of_.end(), cluster_of_[unit]) > 1;
  const auto upper = std::find_if(sides_.begin(), sides_.end(), alone);
  if (coupled || upper == sides_.end()) return 0;
  const double above = unit_value(upper->rates, unit), below = unit_value(sides_.front().rates, unit);
  const double weaker = std::min(std::abs(above), std::abs(below));
  const double stronger = std::max(std::abs(above), std::abs(below));
  return std::min(weaker, std::abs(above - below)) > kDrives * stronger ? above - below : 0;
}

std::optional<double> SlidingMode::repulsion(std::size_t unit) const {
  const double strongest = strongest_[units_[unit]];
  if (!(strongest > 0)) return std::nullopt;
  const double apart = drive_apart(unit);
  if (apart == 0) return std::nullopt;
  const double part = apart / strongest;
  return part > kNoDrive ? part : std::min(part, 0.0);
}

double SlidingMode::unit_value(const std::vector<double>& of_switches, std::size_t unit) const {
  const network::SwitchStructure& structure = program_.switch_structure();
  const std::uint32_t s = structure.members[units_[unit]].front();
  return structure.opposite[s] ? -of_switches[s] : of_switches[s];
}

/// The rate at which a surface that has drifted off goes back.
double SlidingMode::way_back(std::size_t unit, double fastest) const {
  return std::clamp(kReturn / span_ * unit_value(sides_[0].surfaces, unit), -kMostReturn * fastest,
                    kMostReturn * fastest);
}

/// Gives each side its weight for these shares: all together are 1.
double SlidingMode::weigh(std::span<const double> shares) {
  const auto product = [&](std::uint64_t bits, std::uint32_t cluster) {
    double weight = 1;
    for (std::size_t u = 0; u < units_.size(); ++u) {
      if (cluster_of_[u] == cluster) weight *= (bits >> u & 1U) != 0 ? shares[u] : 1 - shares[u];
    }
    return weight;
  };
  double others = 0;
  for (std::size_t k = 1; k < sides_.size(); ++k)
    others += sides_[k].weight = product(sides_[k].bits, *sides_[k].cluster);
  return sides_.front().weight = 1 - others;
}

/// The shares α with which no surface moves: Σ weight(α) · d surface/dt = 0, by Newton's method; linear for
/// units that are not coupled. Where a surface stands still whatever the shares are, any will do for it.
bool SlidingMode::find_shares() {
  constexpr int kMostIterations = 50;
  constexpr double kFar = 1e3;
  const std::size_t n = units_.size();
  if (n == 1) {
    const double below = unit_value(sides_[0].rates, 0), above = unit_value(sides_[1].rates, 0);
    if (!std::isfinite(below - above)) return false;
    if (below == above) {  // a slide stays as it was where its sides say nothing; none begins there
      weigh(shares_);
      return begun_ && std::abs(below) <= kNoDrive * strongest_[units_[0]];
    }
    shares_[0] = (below + way_back(0, std::abs(below - above))) / (below - above);
    // Where the sides hardly drive any more the way back says nothing; what follows is told by `repulsion`.
    if (std::abs(below - above) < kNoDrive * strongest_[units_[0]])
      shares_[0] = std::clamp(shares_[0], 0.0, 1.0);
    weigh(shares_);
    return true;
  }
  const auto size = static_cast<Eigen::Index>(n);
  Eigen::VectorXd residual(size), last(size);
  Eigen::MatrixXd slopes(size, size);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(kNoSlope);
  double scale = std::numeric_limits<double>::min();
  for (const Side& side : sides_) {
    for (std::size_t u = 0; u < n; ++u) scale = std::max(scale, std::abs(unit_value(side.rates, u)));
  }
  const auto residuals = [&](std::span<const double> shares, Eigen::Ref<Eigen::VectorXd> result) {
    weigh(shares);
    for (std::size_t u = 0; u < n; ++u) {
      double sum = way_back(u, scale);
      for (const Side& side : sides_) sum += side.weight * unit_value(side.rates, u);
      result[static_cast<Eigen::Index>(u)] = sum;
    }
  };
  std::vector<double> trial = shares_;
  for (double& share : trial) share = std::clamp(share, 0.0, 1.0);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    residuals(trial, residual);
    if (!residual.allFinite()) return false;
    // The weights are linear in each share: a difference is a slope.
    for (std::size_t u = 0; u < n; ++u) {
      const double share = trial[u];
      trial[u] = share + 1;
      residuals(trial, last);
      slopes.col(static_cast<Eigen::Index>(u)) = last - residual;
      trial[u] = share;
    }
    decomposition.compute(slopes);
    const Eigen::VectorXd step = decomposition.solve(-residual);
    double change = 0;
    for (std::size_t u = 0; u < n; ++u) {
      trial[u] += step[static_cast<Eigen::Index>(u)];
      change = std::max(change, std::abs(step[static_cast<Eigen::Index>(u)]));
      if (!(std::abs(trial[u]) < kFar)) return false;
    }
    if (change < 1e-14) break;
  }
  residuals(trial, residual);
  if (!(residual.cwiseAbs().maxCoeff() <= kMostReturn * scale)) return false;
  shares_ = trial;
  return true;
}

/// Whether the shares are about the same a moment later: those of a surface that merely stands still at this
/// one instant are not.
bool SlidingMode::lasts(double t, std::span<const double> x) {
  constexpr double kJump = 0.01;
  const std::vector<double> now = shares_;
  std::fill(moved_.begin(), moved_.end(), 0.0);
  double fastest = std::numeric_limits<double>::min();
  for (const Side& side : sides_) {
    for (std::size_t i = 0; i < moved_.size(); ++i) moved_[i] += side.weight * side.dxdt[i];
  }
  for (const double rate : moved_) fastest = std::max(fastest, std::abs(rate));
  const double dt = std::min(kProbe / fastest, kProbe * span_);
  for (std::size_t i = 0; i < moved_.size(); ++i) moved_[i] = x[i] + dt * moved_[i];
  const bool valid = evaluate(t + dt, moved_);
  bool stays = valid;
  for (std::size_t u = 0; stays && u < now.size(); ++u) stays = std::abs(shares_[u] - now[u]) < kJump;
  shares_ = now;
  return evaluate(t, x) && stays;
}

void SlidingMode::mixed_rates(std::span<double> rates) const {
  std::fill(rates.begin(), rates.end(), 0.0);
  for (const Side& side : sides_) {
    for (std::size_t s = 0; s < rates.size(); ++s) rates[s] += side.weight * side.rates[s];
  }
}

double SlidingMode::overdue(std::size_t side, std::size_t follower) const {
  const Side& at = sides_[side];
  const std::size_t s = followers_[follower];
  const double position = at.positions[at.positions.size() - followers_.size() + follower].second;
  return position == 1 ? -at.surfaces[s] : at.surfaces[s];
}

bool SlidingMode::is_torn(std::size_t s) const {
  const std::uint32_t memory = program_.switches()[s].memory;
  const auto position_on = [&](const Side& side) {
    const auto found = std::find_if(side.positions.begin(), side.positions.end(),
                                    [&](const auto& setting) { return setting.first == memory; });
    return found->second;
  };
  return std::any_of(sides_.begin(), sides_.end(),
                     [&](const Side& side) { return position_on(side) != position_on(sides_.front()); });
}

bool SlidingMode::derivatives(double t, const double* x, double* dxdt) {
  if (!evaluate(t, {x, program_.n_states()})) return false;
  std::fill(dxdt, dxdt + program_.n_states(), 0.0);
  for (const Side& side : sides_) {
    for (std::size_t i = 0; i < program_.n_states(); ++i) dxdt[i] += side.weight * side.dxdt[i];
  }
  return true;
}

/// Of the mixture with its shares held: enough for Newton's method.
bool SlidingMode::jacobian(double t, const double* x, double* values) {
  if (!evaluate(t, {x, program_.n_states()})) return false;
  const std::size_t entries = program_.jacobian_pattern().entries();
  std::fill(values, values + entries, 0.0);
  bool valid = true;
  for (const Side& side : sides_) {
    load(side);
    valid = valid && program_.jacobian(t, x, scratch_.data(), workspace_);
    for (std::size_t k = 0; k < entries; ++k) values[k] += side.weight * scratch_[k];
  }
  load_base();
  return valid;
}

bool SlidingMode::signals(double t, const double* x, double* values) {
  if (!evaluate(t, {x, program_.n_states()})) return false;
  std::vector<double> shares = shares_;
  for (double& share : shares) share = std::clamp(share, 0.0, 1.0);
  weigh(shares);
  std::vector<double> of_side(program_.n_signals());
  std::fill(values, values + program_.n_signals(), 0.0);
  bool valid = true;
  for (const Side& side : sides_) {
    load(side);
    valid = valid && program_.signals(t, x, of_side.data(), workspace_);
    for (std::size_t i = 0; i < of_side.size(); ++i) values[i] += side.weight * of_side[i];
  }
  load_base();
  return valid;
}

}  // namespace oblique::solve
