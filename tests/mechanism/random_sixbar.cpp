// SPDX-License-Identifier: MIT
#include "random_sixbar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <fmt/format.h>
#include <Eigen/Core>

#include <oblique/mechanism/model/plane.h>

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;
using SixbarChain = std::vector<std::string>;  ///< links by their joints, a letter each

const std::array<SixbarChain, 2> kChains{{{"hab", "hcd", "ae", "ec", "bf", "fd"},    // Watt
                                          {"abc", "def", "ad", "be", "cg", "gf"}}};  // Stephenson

}  // namespace

RandomSixbar random_sixbar(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto fraction = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const auto choice = [&](std::size_t count) { return static_cast<std::size_t>(random() % count); };
  const SixbarChain& chain = kChains.at(seed % 2);
  std::map<char, Vector2d> joints;
  double nearest = 0;
  while (nearest < 0.15) {
    nearest = std::numeric_limits<double>::infinity();
    for (const std::string& link : chain) {
      for (const char joint : link) joints[joint];
    }
    for (auto& [name, at] : joints) at = {2 * fraction() - 1, 2 * fraction() - 1};
    for (const std::string& link : chain) {
      for (std::size_t i = 0; i < link.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j)
          nearest = std::min(nearest, (joints[link[i]] - joints[link[j]]).norm());
      }
    }
  }
  const std::size_t frame = choice(chain.size());
  const auto joint_of = [&](const std::string& link) {
    const auto at = std::find_if(link.begin(), link.end(),
                                 [&](char joint) { return chain[frame].find(joint) != std::string::npos; });
    return at == link.end() ? std::string::npos : static_cast<std::size_t>(at - link.begin());
  };
  std::size_t driven = choice(chain.size());
  while (driven == frame || joint_of(chain[driven]) == std::string::npos) driven = choice(chain.size());

  RandomSixbar mechanism;
  std::string bodies, drive;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    if (i == frame) continue;
    std::string link = chain[i];
    if (i == driven) std::swap(link[0], link[joint_of(link)]);
    const Vector2d way = joints[link[1]] - joints[link[0]];
    const double length = way.norm();
    mechanism.bars.push_back({{link[0]}, {link[1]}, length});
    std::string marks;
    if (link.size() == 3) {
      const Vector2d to = joints[link[2]] - joints[link[0]];
      const double left = cross(way, to) / length;
      marks = fmt::format(", marks = {{ {} = [{:.17g}, {:.17g}] }}", link[2], way.dot(to) / length, left);
      mechanism.bars.push_back({{link[0]}, {link[2]}, to.norm()});
      mechanism.bars.push_back({{link[1]}, {link[2]}, (to - way).norm()});
      mechanism.plates.push_back({{link[0]}, {link[1]}, {link[2]}, left > 0 ? 1 : -1});
    }
    bodies += fmt::format("L{} = {{ points = [\"{}\", \"{}\"], length = {:.17g}{} }}\n", i, link[0], link[1],
                          length, marks);
    if (i == driven) {
      drive = fmt::format("crank = {{ turns = \"L{}\", about = \"{}\", speed = {}, start = {:.17g} }}\n", i,
                          link[0], random() % 2 == 0 ? 1 : -1, std::atan2(way.y(), way.x()));
    }
  }
  std::string fixed, sketch;
  for (const auto& [name, at] : joints) {
    const std::string line = fmt::format("{} = [{:.17g}, {:.17g}]\n", name, at.x(), at.y());
    const bool is_fixed = chain[frame].find(name) != std::string::npos;
    const bool is_driven = chain[driven].find(name) != std::string::npos;
    if (is_fixed) fixed += line;
    if (!is_fixed && !is_driven) sketch += line;
  }
  mechanism.text = "format = \"oblique-mechanism/1\"\n[frame]\n" + fixed + "[bodies]\n" + bodies +
                   "[drives]\n" + drive + "[sketch]\n" + sketch;
  return mechanism;
}

}  // namespace oblique::mechanism
