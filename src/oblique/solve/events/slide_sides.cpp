// SPDX-License-Identifier: MIT
#include <oblique/solve/events/slide_sides.h>

#include <algorithm>

namespace oblique::solve {
namespace {

constexpr std::size_t kMostCoupled = 8;

}  // namespace

Breaks find_breaks(const network::Program& program, const std::vector<std::uint32_t>& units) {
  const network::SwitchStructure& structure = program.switch_structure();
  const std::size_t n = units.size();
  Breaks broken{std::vector<std::uint64_t>(n, 0), std::vector<bool>(n), std::vector<bool>(n)};
  for (std::size_t v = 0; v < n; ++v) {
    std::vector<bool> turns(structure.unit.size(), false);
    for (const std::uint32_t s : structure.members[units[v]]) turns[s] = true;
    const std::vector<bool> follows = structure.followers_of(turns);
    for (std::size_t u = 0; u < n; ++u) {
      for (const std::uint32_t s : structure.members[units[u]]) {
        for (const std::uint32_t p : structure.positions_below(s)) {
          if (!turns[p] && !follows[p]) continue;
          if (u != v && program.switches()[p].turning == network::Turning::jumps)
            broken.by_others[u] |= std::uint64_t{1} << v;
          if (u == v && turns[p]) broken.by_itself[u] = true;
          if (u == v && !turns[p]) broken.by_followers[u] = true;
        }
      }
    }
  }
  return broken;
}

void SlideSides::make(const std::vector<std::uint32_t>& units,
                      const std::vector<std::vector<std::size_t>>& together) {
  const std::size_t n = units.size();
  first_switch_.clear();
  for (const std::uint32_t unit : units) first_switch_.push_back(structure_.members[unit].front());
  cluster_of_.resize(n);
  for (std::size_t u = 0; u < n; ++u) cluster_of_[u] = static_cast<std::uint32_t>(u);
  const auto join = [&](std::size_t u, std::size_t v) {
    const std::uint32_t from = cluster_of_[u], to = cluster_of_[v];
    std::replace(cluster_of_.begin(), cluster_of_.end(), from, to);
  };
  for (const std::vector<std::size_t>& part : together) {
    for (const std::size_t u : part) join(u, part.front());
  }
  for (std::size_t u = 0; u < n; ++u) {
    for (std::size_t v = 0; v < u; ++v) {
      if (structure_.is_coupled(units[u], units[v])) join(u, v);
    }
  }
  sides_.assign(1, SlideSide{});
  for (std::uint32_t cluster = 0; cluster < n; ++cluster) {
    std::vector<std::uint32_t> members;
    for (std::uint32_t u = 0; u < n; ++u) {
      if (cluster_of_[u] == cluster) members.push_back(u);
    }
    for (std::uint32_t combination = 1; combination < (1U << std::min(members.size(), kMostCoupled));
         ++combination) {
      SlideSide side;
      side.cluster = cluster;
      for (std::size_t k = 0; k < members.size(); ++k) {
        if ((combination >> k & 1U) != 0) side.bits |= std::uint64_t{1} << members[k];
      }
      sides_.push_back(std::move(side));
    }
  }
}

void SlideSides::clear() {
  first_switch_.clear();
  cluster_of_.clear();
  sides_.clear();
}

std::size_t SlideSides::cluster_size(std::size_t unit) const {
  return static_cast<std::size_t>(std::count(cluster_of_.begin(), cluster_of_.end(), cluster_of_[unit]));
}

bool SlideSides::are_all() const {
  for (std::size_t unit = 0; unit < units(); ++unit) {
    if (cluster_size(unit) > kMostCoupled) return false;
  }
  return true;
}

bool SlideSides::is_coupled(std::size_t unit) const {
  return cluster_size(unit) > 1;
}

void SlideSides::weigh(std::span<const double> shares) {
  const auto product = [&](std::uint64_t bits, std::uint32_t cluster) {
    double weight = 1;
    for (std::size_t u = 0; u < units(); ++u) {
      if (cluster_of_[u] == cluster) weight *= (bits >> u & 1U) != 0 ? shares[u] : 1 - shares[u];
    }
    return weight;
  };
  double others = 0;
  for (std::size_t k = 1; k < sides_.size(); ++k)
    others += sides_[k].weight = product(sides_[k].bits, *sides_[k].cluster);
  sides_.front().weight = 1 - others;
}

double SlideSides::of_unit(const std::vector<double>& of_switches, std::size_t unit) const {
  const std::uint32_t s = first_switch_[unit];
  return structure_.opposite[s] ? -of_switches[s] : of_switches[s];
}

}  // namespace oblique::solve
